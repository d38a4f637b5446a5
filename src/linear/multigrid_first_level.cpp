// The first level leaves out small weights and raises those it keeps to the same row sum. The Laplacian's weights fall
// off steeply, so half of them (2D) or a fifth (3D) have nearly the effect of all, and the rest of the cycle costs
// little. The matrix of the level is an M-matrix even where the given one is not.
// an M-matrix even where the given one is not.
//
// Rows that have a cell come first. Rows without a cell follow from others, as the dummies of a wall do. Rows without
// weights keep a row of their own.
#include <algorithm>
#include <array>
#include <limits>

#include "base/batch.h"
#include "base/room.h"
#include "linear/multigrid_level.h"

namespace tailwater::multigrid {
namespace {

/// Weights below this fraction of their row's sum are left out.
constexpr double min_share = 0.02;

/// To estimate the number of large weights, every row whose index is a multiple of this number is examined.
constexpr int sampled = 16;

/// Four partial sums, so that an addition need not wait for the previous one.
double sum_of_weights(std::span<const float> weights) {
  std::array<double, 4> partial{};
  std::size_t k = 0;
  for (; k + 4 <= weights.size(); k += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) partial[lane] += weights[k + lane];
  }
  for (; k < weights.size(); ++k) partial[0] += weights[k];
  return (partial[0] + partial[1]) + (partial[2] + partial[3]);
}

std::size_t count_from(float least, std::span<const float> weights) {
  unsigned count = 0;
  for (const float weight : weights) count += weight >= least ? 1 : 0;
  return count;
}

/// Statistics of the rows, before any row is taken.
struct Survey {
  std::vector<double> total;  ///< sum of each row's weights, before scaling; 0 for rows x_i = 0
  std::size_t large = 0;      ///< estimated number of weights that will be kept
  std::size_t longest = 0;    ///< length of the longest row
};

Survey survey(const LinearSystem& system) {
  const LinearSystem::Part part = system.whole();
  Survey found{.total = std::vector<double>(system.size())};
  for (std::size_t i = 0; i < system.size(); ++i) {
    if (system.scale(i) == 0.0) continue;
    const std::span weights(part.weight + part.begin[i], part.weight + part.end[i]);
    found.total[i] = system.sum_of_weights(i);
    found.longest = std::max(found.longest, weights.size());
    if (i % sampled == 0) {
      found.large += sampled * count_from(static_cast<float>(min_share * found.total[i]), weights);
    }
  }
  return found;
}

/// The large weights of a row and their columns.
class LargeWeights {
 public:
  explicit LargeWeights(std::size_t longest) : columns_(longest + batch_size), weights_(longest + batch_size) {}

  /// Selects the large weights of row i, whose weights have the sum `total`. Returns their number.
  std::size_t find(const LinearSystem::Part& part, std::size_t i, double total) {
    keep_from(static_cast<float>(min_share * total), part, i);
    if (count_ == 0) keep_from(std::numeric_limits<float>::min(), part, i);  // many weights, all of them small
    return count_;
  }

  double sum() const { return sum_of_weights(std::span(weights_).first(count_)); }
  int column(std::size_t k) const { return columns_[k]; }
  float weight(std::size_t k) const { return weights_[k]; }

 private:
  void keep_from(float least, const LinearSystem::Part& part, std::size_t i) {
    std::size_t count = 0;
    std::size_t k = part.begin[i];
    for (; k + batch_size <= part.end[i]; k += batch_size) {
      const unsigned large_ones = bits_of(batch_at<FloatBatch>(part.weight + k) >= least);
      write_chosen(part.column + k, large_ones, columns_.data() + count);
      count = write_chosen(part.weight + k, large_ones, weights_.data() + count) - weights_.data();
    }
    for (; k < part.end[i]; ++k) {
      columns_[count] = part.column[k];  // the place of the next weight, unless this one is kept
      weights_[count] = part.weight[k];
      count += part.weight[k] >= least ? 1 : 0;
    }
    count_ = count;
  }

  std::vector<std::int32_t> columns_;
  std::vector<float> weights_;
  std::size_t count_ = 0;
};

/// The system's rows in the order of the level. Returns the place of each.
std::vector<int> order_rows(std::span<const std::uint64_t> cell, std::span<const double> total, FirstLevel& first) {
  std::vector<int> place(cell.size());
  first.row.reserve(cell.size());
  for (const bool in_cells : {true, false}) {
    for (std::size_t i = 0; i < cell.size(); ++i) {
      if ((total[i] > 0.0 && cell[i] != Cells::none) != in_cells) continue;
      place[i] = static_cast<int>(first.row.size());
      first.row.push_back(static_cast<int>(i));
      if (in_cells) first.level.cell.push_back(cell[i]);
    }
  }
  return place;
}

/// Takes the rows in the level's order. Columns of other ranks get their numbers over all ranks, counted from behind
/// the rows; these numbers are returned. Images are replaced by their owners.
std::vector<int> take_rows(const LinearSystem& system, const Survey& survey, std::span<const int> place,
                           FirstLevel& first) {
  const auto rows = static_cast<int>(system.size());
  const auto column_of = [&](std::int32_t column) {
    if (column < rows) return column;
    const std::int64_t number = system.number_of_ghost(column);
    const std::int64_t own = number - system.first_number();
    return own >= 0 && own < rows ? static_cast<int>(own) : rows + static_cast<int>(number);
  };
  const LinearSystem::Part part = system.whole();
  std::vector<int> needed;
  LargeWeights large(survey.longest);
  std::vector<Entry> kept(survey.longest);
  first.level.matrix.reserve(rows, with_room(survey.large));
  for (const int i : first.row) {
    std::size_t count = 0;
    if (survey.total[i] > 0.0) {
      count = large.find(part, i, survey.total[i]);
      const auto raise = static_cast<float>(system.scale(i) * survey.total[i] / large.sum());
      for (std::size_t k = 0; k < count; ++k) {
        const int column = column_of(large.column(k));
        if (column >= rows) needed.push_back(column - rows);
        kept[k] = {column < rows ? place[column] : column, raise * large.weight(k)};
      }
    }
    first.level.matrix.add_row(std::span(kept).first(count), 1.0);
  }
  return needed;
}

/// Informs the other ranks which of their rows are needed: `needed`, numbers over all ranks, ascending. These rows are
/// the ghosts.
Couplings couple(const LinearSystem& system, std::span<const int> needed, std::span<const int> place) {
  const Communicator& ranks = system.ranks();
  const std::int64_t first = ranks.sum_before(static_cast<std::int64_t>(system.size()));
  const std::vector<std::int64_t> firsts = ranks.all_gather(first);
  std::vector<std::vector<std::int32_t>> questions(firsts.size());
  Couplings couplings;
  couplings.received.assign(firsts.size(), 0);
  for (std::size_t k = 0; k < needed.size(); ++k) {
    const auto owner = std::upper_bound(firsts.begin(), firsts.end(), needed[k]) - firsts.begin() - 1;
    questions[owner].push_back(static_cast<std::int32_t>(k));
    ++couplings.received[owner];
  }
  const std::vector<int> asked = [&] {
    std::vector<int> numbers(needed.begin(), needed.end());
    const ExchangePlan plan(ranks, needed.size(), questions);
    plan.exchange(numbers);
    numbers.erase(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(needed.size()));
    return numbers;
  }();
  auto next = asked.begin();
  for (const std::int64_t count : ranks.transpose(couplings.received)) {
    std::vector<std::int32_t>& sent = couplings.sent.emplace_back();
    for (std::int64_t k = 0; k < count; ++k) sent.push_back(place[*next++ - first]);
  }
  couplings.plan = ExchangePlan(ranks, system.size(), couplings.sent);
  return couplings;
}

/// Replaces the numbers of other ranks' columns by those of ghosts.
void number_ghosts(Matrix& matrix, std::span<const int> needed) {
  const auto rows = static_cast<int>(matrix.size());
  for (Entry& entry : matrix.entries) {
    if (entry.column < rows) continue;
    const auto number = std::lower_bound(needed.begin(), needed.end(), entry.column - rows);
    entry.column = rows + static_cast<int>(number - needed.begin());
  }
}

}  // namespace

FirstLevel first_level(const LinearSystem& system) {
  FirstLevel first;
  Level& level = first.level;
  level.is_whole = system.ranks().is_alone();
  const Survey found = survey(system);
  const std::vector<int> place = order_rows(system.cells().number, found.total, first);
  std::vector<int> needed = take_rows(system, found, place, first);
  if (!level.is_whole) {
    std::sort(needed.begin(), needed.end());
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    level.couplings = couple(system, needed, place);
    number_ghosts(level.matrix, needed);
  }
  level.rhs.resize(system.size());
  level.solution.resize(system.size());
  first.scale.reserve(system.size());
  for (const int i : first.row) first.scale.push_back(static_cast<float>(system.scale(i)));
  return first;
}

}  // namespace tailwater::multigrid
