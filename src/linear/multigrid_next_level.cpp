// The next level has a row for each cell. With P the map from cells to rows, its matrix is P^T A P (Galerkin), divided
// by over_correction.
//
// Rows without a cell follow from others, as the dummies of a wall do. Corrections reach them through their weights, as
// if they were eliminated. Rows without weights keep a row of their own.
#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "linear/multigrid_level.h"

namespace tailwater::multigrid {
namespace {

/// Levels with fewer rows than this are gathered on all ranks, which costs less than the messages of all coarser ones.
constexpr std::int64_t gathered_rows = 1024;

/// Special values of the parent, for rows without a cell.
constexpr int stands_for_itself = -1;
constexpr int follows = -2;

/// Sums values by column, one row after another.
class RowSum {
 public:
  explicit RowSum(std::size_t columns) : sum_(columns, 0.0), is_there_(columns, 0), columns_(columns + 1) {}

  void add(int column, double value) {
    sum_[column] += value;
    columns_[count_] = column;  // the place of the next column, unless this one is new: a branch could not be predicted
    count_ += is_there_[column] == 0 ? 1 : 0;
    is_there_[column] = 1;
  }

  /// Calls body(column, sum) for each column, in the order of their first appearance, and begins a new row.
  template <class Body>
  void finish(Body&& body) {
    for (std::size_t k = 0; k < count_; ++k) {
      const int column = columns_[k];
      body(column, sum_[column]);
      sum_[column] = 0.0;
      is_there_[column] = 0;
    }
    count_ = 0;
  }

 private:
  std::vector<double> sum_;
  std::vector<std::uint8_t> is_there_;
  std::vector<int> columns_;
  std::size_t count_ = 0;
};

/// The rows cell by cell. Sorts by some bits at a time, the lowest first, and skips bits in which all cells agree.
std::vector<int> rows_by_cell(std::span<const std::uint64_t> cell) {
  constexpr int bits = 8;
  constexpr std::uint64_t mask = (1U << bits) - 1;
  std::vector<int> rows(cell.size());
  std::iota(rows.begin(), rows.end(), 0);
  if (std::is_sorted(cell.begin(), cell.end())) return rows;
  std::uint64_t differs = 0;
  for (const std::uint64_t number : cell) differs |= number ^ cell.front();
  std::vector<int> sorted(rows.size());
  for (int shift = 0; shift < 64; shift += bits) {
    if ((differs >> shift & mask) == 0) continue;
    std::array<std::size_t, mask + 2> begin{};
    for (const int i : rows) ++begin[(cell[i] >> shift & mask) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const int i : rows) sorted[begin[cell[i] >> shift & mask]++] = i;
    rows.swap(sorted);
  }
  return rows;
}

/// The effect of a correction by cells on the rows that follow from others.
class Followers {
 public:
  /// `parent` is that of each row and ghost; the rows from `first` on have no cell. `sum` has the columns of the next
  /// level.
  Followers(const Matrix& matrix, std::size_t first, std::span<const int> parent, RowSum& sum) : first_(first) {
    for (std::size_t i = first; i < matrix.size(); ++i) {
      for (const Entry& entry : matrix.row(i)) {
        if (parent[entry.column] >= 0) sum.add(parent[entry.column], entry.weight);
      }
      sum.finish([&](int column, double share) { shares_.push_back({column, static_cast<float>(share)}); });
      begin_.push_back(shares_.size());
    }
  }

  /// The cells that row i follows, and their fractions.
  std::span<const Entry> of(std::size_t i) const {
    return {shares_.data() + begin_[i - first_], shares_.data() + begin_[i - first_ + 1]};
  }

 private:
  std::size_t first_;
  std::vector<std::size_t> begin_{0};
  std::vector<Entry> shares_;
};

/// Assigns the rows of `fine`, cell by cell, to the rows of `next`; `rows` are those with a cell. Returns the row of
/// `next` for each row, or a special value.
std::vector<int> find_parents(Level& fine, Level& next, std::span<const int> rows, int dimension) {
  std::vector<int> parent(fine.matrix.size());
  for (std::size_t i = rows.size(); i < parent.size(); ++i) {
    parent[i] = fine.matrix.row(i).empty() ? stands_for_itself : follows;
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::uint64_t cell = fine.cell[rows[k]];
    if (k == 0 || cell != fine.cell[rows[k - 1]]) next.cell.push_back(cell >> dimension);
    parent[rows[k]] = static_cast<int>(next.cell.size()) - 1;
  }
  fine.cells = next.cell.size();
  fine.parent.assign(parent.begin(), parent.begin() + static_cast<std::ptrdiff_t>(rows.size()));
  return parent;
}

/// Appends to `parent` the parent of each ghost of `fine`: a column of the next level, or a special value. Ranks agree
/// on the next level's ghosts without messages: they are the cells of this level's ghosts, in the order of first
/// appearance.
void find_parents_of_ghosts(const Level& fine, Level& next, std::vector<int>& parent, const Communicator& ranks) {
  fine.exchange(parent);
  for (const std::vector<std::int32_t>& sent : fine.couplings.sent) {
    std::vector<std::int32_t>& cells = next.couplings.sent.emplace_back();
    std::vector<bool> is_sent(next.cell.size());
    for (const std::int32_t row : sent) {
      if (parent[row] < 0 || is_sent[parent[row]]) continue;
      is_sent[parent[row]] = true;
      cells.push_back(parent[row]);
    }
  }
  auto ghost = parent.begin() + static_cast<std::ptrdiff_t>(fine.matrix.size());
  auto column = static_cast<int>(next.cell.size());
  for (const std::int64_t count : fine.couplings.received) {
    const int first = column;
    std::unordered_map<int, int> column_of;
    for (const auto end = ghost + count; ghost != end; ++ghost) {
      if (*ghost < 0) continue;
      const auto [found, is_new] = column_of.try_emplace(*ghost, column);
      if (is_new) ++column;
      *ghost = found->second;
    }
    next.couplings.received.push_back(column - first);
  }
  next.couplings.plan = ExchangePlan(ranks, next.cell.size(), next.couplings.sent);
}

/// P^T A P / over_correction, where `rows` are the rows of `matrix` that have a cell, cell by cell.
Matrix coarse_matrix(const Matrix& matrix, std::span<const int> rows, std::span<const int> parent, std::size_t cells,
                     std::size_t columns) {
  RowSum sum(columns);
  const Followers followers(matrix, rows.size(), parent, sum);
  const auto add = [&](int cell, const Entry& entry) {
    const int column = parent[entry.column];
    if (column >= 0) sum.add(column, -entry.weight);
    if (column != follows) return;
    const auto i = static_cast<std::size_t>(entry.column);
    if (i >= matrix.size()) {
      sum.add(cell, -entry.weight);  // row of another rank: treated as if it followed this cell alone
      return;
    }
    for (const Entry& share : followers.of(i)) sum.add(share.column, -entry.weight * share.weight);
  };
  Matrix coarse;
  coarse.reserve(cells, matrix.entries.size() / 3);  // more than needed; the unused part takes no memory
  std::vector<Entry> row;
  auto next_row = rows.begin();
  for (int cell = 0; cell < static_cast<int>(cells); ++cell) {
    for (; next_row != rows.end() && parent[*next_row] == cell; ++next_row) {
      sum.add(cell, matrix.diagonal[*next_row]);
      for (const Entry& entry : matrix.row(*next_row)) add(cell, entry);
    }
    double diagonal = 0.0;
    row.clear();
    sum.finish([&](int column, double value) {
      if (column == cell) {
        diagonal = value / over_correction;
      } else {
        row.push_back({column, static_cast<float>(-value / over_correction)});
      }
    });
    coarse.add_row(row, diagonal);
  }
  return coarse;
}

/// Replaces the part of a level that a rank has by the whole level.
void gather(Level& level, const Communicator& ranks) {
  struct NumberedEntry {
    int row;
    int column;
    float weight;
  };
  const Matrix& part = level.matrix;
  const auto first = static_cast<int>(ranks.sum_before(static_cast<std::int64_t>(part.size())));
  std::vector<int> number(part.size());
  std::iota(number.begin(), number.end(), first);
  level.couplings.plan.exchange(number);
  std::vector<NumberedEntry> numbered;
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (const Entry& entry : part.row(i)) numbered.push_back({number[i], number[entry.column], entry.weight});
  }
  Gathering gathering;
  gathering.counts = ranks.all_gather(static_cast<int>(part.size()));
  gathering.first_own = static_cast<std::size_t>(first);
  const std::vector<std::uint64_t> cell = ranks.all_gather(level.cell, gathering.counts);
  const std::vector<float> diagonal = ranks.all_gather(part.diagonal, gathering.counts);
  const std::vector<int> counts_of_entries = ranks.all_gather(static_cast<int>(numbered.size()));
  const std::vector<NumberedEntry> entries = ranks.all_gather(numbered, counts_of_entries);

  std::vector<int> order(cell.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return cell[a] < cell[b]; });
  gathering.row.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) gathering.row[order[i]] = static_cast<int>(i);
  std::vector<std::size_t> begin(order.size() + 1, 0);
  for (const NumberedEntry& entry : entries) ++begin[entry.row + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());

  Level whole;
  std::vector<Entry> row;
  for (const int i : order) {
    row.clear();
    for (std::size_t k = begin[i]; k < begin[i + 1]; ++k) {
      row.push_back({gathering.row[entries[k].column], entries[k].weight});
    }
    whole.matrix.add_row(row, diagonal[i]);
    whole.cell.push_back(cell[i]);
  }
  whole.is_whole = true;
  whole.gathering = std::move(gathering);
  level = std::move(whole);
}

}  // namespace

Level next_level(Level& fine, int dimension, const Communicator& ranks) {
  Level next;
  next.is_whole = fine.is_whole;
  const std::vector<int> rows = rows_by_cell(fine.cell);
  std::vector<int> parent = find_parents(fine, next, rows, dimension);
  if (!fine.is_whole) find_parents_of_ghosts(fine, next, parent, ranks);
  const std::size_t columns = next.cell.size() + next.couplings.plan.ghosts();
  next.matrix = coarse_matrix(fine.matrix, rows, parent, next.cell.size(), columns);
  if (!next.is_whole && ranks.sum(static_cast<std::int64_t>(next.cell.size())) <= gathered_rows) gather(next, ranks);
  next.rhs.resize(next.matrix.size());
  next.solution.resize(next.matrix.size());
  std::vector<std::uint64_t>().swap(fine.cell);
  return next;
}

}  // namespace tailwater::multigrid
