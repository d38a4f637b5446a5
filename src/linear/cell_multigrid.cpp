#include "linear/cell_multigrid.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "base/assert.h"
#include "base/batch.h"
#include "base/room.h"

namespace tailwater {
namespace {

/// Weights below this share of their row's sum are left out of the first level.
constexpr double least_share = 0.02;

/// How much too small corrections are that are constant in a cell.
constexpr double over_correction = 1.8;

/// Levels behind the first that learn of its rows' changes without a new set-up.
constexpr std::size_t held_levels = 2;

/// Of so many rows one is looked at to tell how many large weights there are.
constexpr int sampled = 16;

/// Rows of the level that is solved directly.
constexpr std::size_t coarsest_rows = 32;

/// Levels with fewer rows than this are gathered on all ranks, which costs less than the messages of all coarser ones.
constexpr std::int64_t gathered_rows = 1024;

/// Pivots of the coarsest level below this share of the largest are rounding: a constant is free.
constexpr double vanishing_pivot = 1e-6;

/// Values of the solution below this, where the right-hand side's largest is 1, become 0. They arise far from any
/// source and would soon leave the range of normal numbers, which slows processors down.
constexpr float vanishing_value = 1e-20F;

/// Parents of rows without a cell.
constexpr int stands_for_itself = -1;
constexpr int follows = -2;

/// Sums values by column, one row after another.
class RowSum {
 public:
  explicit RowSum(std::size_t columns) : sum_(columns, 0.0), is_there_(columns, 0), columns_(columns + 1) {}

  void add(int column, double value) {
    sum_[column] += value;
    columns_[count_] = column;  // the next one's place, unless it is new: a branch could not be predicted
    count_ += is_there_[column] == 0 ? 1 : 0;
    is_there_[column] = 1;
  }

  /// Calls body(column, sum) for each column, in the order in which they came, and begins a new row.
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

/// Four partial sums, so that an addition need not wait for the one before it.
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

/// The rows cell by cell. Sorts by some bits at a time, the lowest first, and passes over bits in
/// which all cells agree.
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

float settled(float value) { return std::abs(value) < vanishing_value ? 0.0F : value; }

}  // namespace

void CellMultigrid::Matrix::reserve(std::size_t rows, std::size_t entries_of_all) {
  begin.reserve(rows + 1);
  middle.reserve(rows);
  diagonal.reserve(rows);
  inverse.reserve(rows);
  entries.reserve(entries_of_all + 1);  // which adding a row writes to
}

void CellMultigrid::Matrix::add_row(std::span<const Entry> row, double diagonal_of_row) {
  const auto i = static_cast<int>(size());
  const std::size_t first = entries.size();
  entries.resize(first + row.size() + 1);
  Entry* next = entries.data() + first;
  // Each entry is written where the next one of its side belongs, and stays if it is of that side: without a branch,
  // which nobody can predict.
  for (const Entry& entry : row) {
    *next = entry;
    next += entry.column < i ? 1 : 0;
  }
  middle.push_back(static_cast<int>(next - entries.data()));
  for (const Entry& entry : row) {
    *next = entry;
    next += entry.column > i ? 1 : 0;
  }
  entries.resize(next - entries.data());
  begin.push_back(static_cast<int>(entries.size()));
  diagonal.push_back(static_cast<float>(diagonal_of_row));
  inverse.push_back(diagonal_of_row > 0.0 ? static_cast<float>(1.0 / diagonal_of_row) : 0.0F);
}

CellMultigrid::CellMultigrid(LinearSystem& system)
    : ranks_(system.ranks()), dimension_(system.cells().dimension), constant_is_free_(system.constant_is_free()) {
  TAILWATER_ASSERT(system.cells().number.size() == system.size(), "a multigrid on cells needs the cell of each row");
  take_rows(system);
  do {
    add_next_level();
  } while (!levels_.back().is_whole || levels_.back().matrix.size() > coarsest_rows);
  invert_coarsest();
}

/// Puts the system's rows in order: those that have a cell, then those without one or without weights, whose sums are
/// `total`. Returns the place of each row.
std::vector<int> CellMultigrid::order_rows(std::span<const std::uint64_t> cell, std::span<const double> total,
                                           Level& level) {
  std::vector<int> place(cell.size());
  row_.reserve(cell.size());
  for (const bool in_cells : {true, false}) {
    for (std::size_t i = 0; i < cell.size(); ++i) {
      if ((total[i] > 0.0 && cell[i] != Cells::none) != in_cells) continue;
      place[i] = static_cast<int>(row_.size());
      row_.push_back(static_cast<int>(i));
      if (in_cells) level.cell.push_back(cell[i]);
    }
  }
  return place;
}

/// Makes the first level.
void CellMultigrid::take_rows(LinearSystem& system) {
  const auto rows = static_cast<int>(system.size());
  // Columns of other ranks are numbered behind the rows until all that are needed are known; images are their owners.
  const auto column_of = [&](std::int32_t column) {
    if (column < rows) return column;
    const std::int64_t number = system.number_of_ghost(column);
    const std::int64_t own = number - system.first_number();
    return own >= 0 && own < rows ? static_cast<int>(own) : rows + static_cast<int>(number);
  };
  const LinearSystem::Part part = system.whole();
  std::vector<double> total(rows);  // of the weights, before scaling; 0 for rows x_i = 0
  std::size_t large = 0;
  std::size_t longest = 0;
  for (int i = 0; i < rows; ++i) {
    if (system.scale(i) == 0.0) continue;
    const std::span weights(part.weight + part.begin[i], part.weight + part.end[i]);
    total[i] = system.sum_of_weights(i);
    longest = std::max(longest, weights.size());
    if (i % sampled == 0) large += sampled * count_from(static_cast<float>(least_share * total[i]), weights);
  }

  Level level;
  level.is_whole = ranks_.is_alone();
  const std::vector<int> place = order_rows(system.cells().number, total, level);
  level.matrix.reserve(rows, with_room(large));
  std::vector<int> needed;  // of other ranks
  std::vector<std::int32_t> columns(longest + batch);
  std::vector<float> weights(longest + batch);
  std::vector<Entry> kept(longest);
  for (const int i : row_) {
    std::size_t count = 0;
    const auto keep_from = [&](float least) {
      std::size_t k = part.begin[i];
      for (; k + batch <= part.end[i]; k += batch) {
        const unsigned large_ones = bits_of(batch_at<FloatBatch>(part.weight + k) >= least);
        write_chosen(part.column + k, large_ones, columns.data() + count);
        count = write_chosen(part.weight + k, large_ones, weights.data() + count) - weights.data();
      }
      for (; k < part.end[i]; ++k) {
        columns[count] = part.column[k];  // the next one's place, unless it is kept
        weights[count] = part.weight[k];
        count += part.weight[k] >= least ? 1 : 0;
      }
    };
    if (total[i] > 0.0) {
      keep_from(static_cast<float>(least_share * total[i]));
      if (count == 0) keep_from(std::numeric_limits<float>::min());  // many weights, all of them small
      const double sum = sum_of_weights(std::span(weights).first(count));
      const auto raise = static_cast<float>(system.scale(i) * total[i] / sum);
      for (std::size_t k = 0; k < count; ++k) {
        const int column = column_of(columns[k]);
        if (column >= rows) needed.push_back(column - rows);
        kept[k] = {column < rows ? place[column] : column, raise * weights[k]};
      }
    }
    level.matrix.add_row(std::span(kept).first(count), 1.0);
  }
  if (!ranks_.is_alone()) {
    level.couplings = couple(system, needed, place);
    for (Entry& entry : level.matrix.entries) {
      if (entry.column < rows) continue;
      const auto number = std::lower_bound(needed.begin(), needed.end(), entry.column - rows);
      entry.column = rows + static_cast<int>(number - needed.begin());
    }
  }
  level.rhs.resize(rows);
  level.solution.resize(rows);
  levels_.push_back(std::move(level));
  scale_.reserve(rows);
  for (const int i : row_) scale_.push_back(static_cast<float>(system.scale(i)));
}

bool CellMultigrid::follow(const LinearSystem& system) {
  bool has_changed = false;
  Matrix& matrix = levels_.front().matrix;
  for (std::size_t i = 0; i < row_.size(); ++i) {
    const auto scale = static_cast<float>(system.scale(row_[i]));
    if (scale == scale_[i] || scale_[i] == 0.0F) continue;
    const float share = scale / scale_[i];
    float lost = 0.0F;  // of the row's weights
    for (int k = matrix.begin[i]; k < matrix.begin[i + 1]; ++k) {
      lost += (1.0F - share) * matrix.entries[k].weight;
      matrix.entries[k].weight *= share;
    }
    hold_cells(i, lost);
    scale_[i] = scale;
    has_changed = true;
  }
  return has_changed;
}

/// After row i of the first level has lost weights: raises the diagonals of its cells on the next levels, whose rows
/// keep their weights, so that their sums are right.
void CellMultigrid::hold_cells(std::size_t i, float lost) {
  for (std::size_t k = 0; k < held_levels && k + 1 < levels_.size(); ++k) {
    if (i >= levels_[k].parent.size() || levels_[k + 1].gathering) return;
    i = levels_[k].parent[i];
    lost /= static_cast<float>(over_correction);
    Matrix& matrix = levels_[k + 1].matrix;
    matrix.diagonal[i] += lost;
    matrix.inverse[i] = 1.0F / matrix.diagonal[i];
  }
}

/// Tells the other ranks which of their rows are needed: `needed`, numbers over all ranks, which it sorts. These are
/// the ghosts.
CellMultigrid::Couplings CellMultigrid::couple(const LinearSystem& system, std::vector<int>& needed,
                                               std::span<const int> place) const {
  std::sort(needed.begin(), needed.end());
  needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
  const std::int64_t first = ranks_.sum_before(static_cast<std::int64_t>(system.size()));
  const std::vector<std::int64_t> firsts = ranks_.all_gather(first);
  std::vector<std::vector<std::int32_t>> questions(firsts.size());
  Couplings couplings;
  couplings.received.assign(firsts.size(), 0);
  for (std::size_t k = 0; k < needed.size(); ++k) {
    const auto owner = std::upper_bound(firsts.begin(), firsts.end(), needed[k]) - firsts.begin() - 1;
    questions[owner].push_back(static_cast<std::int32_t>(k));
    ++couplings.received[owner];
  }
  const std::vector<int> asked = [&] {
    std::vector<int> numbers = needed;
    const ExchangePlan plan(ranks_, needed.size(), questions);
    plan.exchange(numbers);
    numbers.erase(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(needed.size()));
    return numbers;
  }();
  auto next = asked.begin();
  for (const std::int64_t count : ranks_.transpose(couplings.received)) {
    std::vector<std::int32_t>& sent = couplings.sent.emplace_back();
    for (std::int64_t k = 0; k < count; ++k) sent.push_back(place[*next++ - first]);
  }
  couplings.plan = ExchangePlan(ranks_, system.size(), couplings.sent);
  return couplings;
}

/// Divides the rows of `fine`, of which `rows` are those with a cell, cell by cell, among the rows of `next`. Returns
/// of each row and ghost its row there: a column of the next level, or that it has none. Ranks agree on the next
/// level's ghosts without asking: they are the cells of this level's, each when it comes up first.
std::vector<int> CellMultigrid::find_parents(Level& fine, Level& next, std::span<const int> rows) const {
  std::vector<int> parent(fine.matrix.size());
  for (std::size_t i = rows.size(); i < parent.size(); ++i) {
    parent[i] = fine.matrix.row(i).empty() ? stands_for_itself : follows;
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::uint64_t cell = fine.cell[rows[k]];
    if (k == 0 || cell != fine.cell[rows[k - 1]]) next.cell.push_back(cell >> dimension_);
    parent[rows[k]] = static_cast<int>(next.cell.size()) - 1;
  }
  fine.cells = next.cell.size();
  fine.parent.assign(parent.begin(), parent.begin() + static_cast<std::ptrdiff_t>(rows.size()));
  if (fine.is_whole) return parent;

  fine.couplings.plan.exchange(parent);
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
  next.couplings.plan = ExchangePlan(ranks_, next.cell.size(), next.couplings.sent);
  return parent;
}

/// Makes the level behind the last.
void CellMultigrid::add_next_level() {
  Level& fine = levels_.back();
  Level next;
  next.is_whole = fine.is_whole;
  const std::vector<int> rows = rows_by_cell(fine.cell);
  const std::vector<int> parent = find_parents(fine, next, rows);
  const Matrix& matrix = fine.matrix;
  const std::size_t columns = next.cell.size() + next.couplings.plan.ghosts();

  // Rows that follow from others: the cells whose corrections reach them, and with which shares.
  const std::size_t first_without = rows.size();
  std::vector<std::size_t> shares_begin{0};
  std::vector<Entry> shares;
  RowSum sum(columns);
  for (std::size_t i = first_without; i < matrix.size(); ++i) {
    for (const Entry& entry : matrix.row(i)) {
      if (parent[entry.column] >= 0) sum.add(parent[entry.column], entry.weight);
    }
    sum.finish([&](int column, double share) { shares.push_back({column, static_cast<float>(share)}); });
    shares_begin.push_back(shares.size());
  }

  const auto add = [&](int cell, const Entry& entry) {
    const int column = parent[entry.column];
    if (column >= 0) sum.add(column, -entry.weight);
    if (column != follows) return;
    const auto i = static_cast<std::size_t>(entry.column);
    if (i >= matrix.size()) {
      sum.add(cell, -entry.weight);  // another rank's: as if it followed this cell alone
      return;
    }
    for (std::size_t k = shares_begin[i - first_without]; k < shares_begin[i - first_without + 1]; ++k) {
      sum.add(shares[k].column, -entry.weight * shares[k].weight);
    }
  };
  std::vector<Entry> row;
  auto next_row = rows.begin();
  for (int cell = 0; cell < static_cast<int>(next.cell.size()); ++cell) {
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
    next.matrix.add_row(row, diagonal);
  }
  if (!next.is_whole && ranks_.sum(static_cast<std::int64_t>(next.cell.size())) <= gathered_rows) gather(next);
  next.rhs.resize(next.matrix.size());
  next.solution.resize(next.matrix.size());
  std::vector<std::uint64_t>().swap(fine.cell);
  levels_.push_back(std::move(next));
}

/// Turns the part of a level that a rank has into the whole.
void CellMultigrid::gather(Level& level) const {
  struct NumberedEntry {
    int row;
    int column;
    float weight;
  };
  const Matrix& part = level.matrix;
  const auto first = static_cast<int>(ranks_.sum_before(static_cast<std::int64_t>(part.size())));
  std::vector<int> number(part.size());
  std::iota(number.begin(), number.end(), first);
  level.couplings.plan.exchange(number);
  std::vector<NumberedEntry> numbered;
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (const Entry& entry : part.row(i)) numbered.push_back({number[i], number[entry.column], entry.weight});
  }
  Gathering gathering;
  gathering.counts = ranks_.all_gather(static_cast<int>(part.size()));
  gathering.first_own = static_cast<std::size_t>(first);
  const std::vector<std::uint64_t> cell = ranks_.all_gather(level.cell, gathering.counts);
  const std::vector<float> diagonal = ranks_.all_gather(part.diagonal, gathering.counts);
  const std::vector<int> counts_of_entries = ranks_.all_gather(static_cast<int>(numbered.size()));
  const std::vector<NumberedEntry> entries = ranks_.all_gather(numbered, counts_of_entries);

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

void CellMultigrid::invert_coarsest() {
  const Matrix& matrix = levels_.back().matrix;
  const auto size = static_cast<Eigen::Index>(matrix.size());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    dense(i, i) = matrix.diagonal[i];
    for (const Entry& entry : matrix.row(i)) dense(i, entry.column) -= entry.weight;
  }
  if (size == 0) return;
  Eigen::FullPivLU<Eigen::MatrixXd> factors(dense);
  factors.setThreshold(vanishing_pivot);
  coarsest_inverse_ = factors.solve(Eigen::MatrixXd::Identity(size, size)).cast<float>();
}

void CellMultigrid::apply(std::span<const double> residual, std::span<double> correction) {
  double scale = 0.0;
  for (const double value : residual) scale = std::max(scale, std::abs(value));
  scale = ranks_.largest(scale);
  std::fill(correction.begin(), correction.end(), 0.0);
  if (scale == 0.0) return;
  Level& level = levels_.front();
  for (std::size_t i = 0; i < row_.size(); ++i) level.rhs[i] = static_cast<float>(residual[row_[i]] / scale);
  cycle(0);
  for (std::size_t i = 0; i < row_.size(); ++i) correction[row_[i]] = scale * level.solution[i];
  if (!constant_is_free_) return;
  double sum = std::accumulate(correction.begin(), correction.end(), 0.0);
  auto count = static_cast<double>(correction.size());
  ranks_.sum_each(sum, count);
  for (double& value : correction) value -= sum / count;
}

/// Solves level k roughly, from 0.
void CellMultigrid::cycle(std::size_t k) {
  Level& level = levels_[k];
  std::vector<float>& x = level.solution;
  if (k + 1 == levels_.size()) {
    using Vector = Eigen::Map<Eigen::VectorXf>;
    const auto size = static_cast<Eigen::Index>(x.size());
    Vector(x.data(), size).noalias() = coarsest_inverse_ * Vector(level.rhs.data(), size);
    return;
  }
  const Matrix& matrix = level.matrix;
  const auto relax = [&](std::size_t i) { x[i] = settled(matrix.inverse[i] * (level.rhs[i] + matrix.sum_all(i, x))); };
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    x[i] = settled(matrix.inverse[i] * (level.rhs[i] + matrix.sum_left(i, x)));
  }
  correct_by_next(k);
  if (!level.is_whole) level.couplings.plan.exchange(x);
  for (std::size_t i = matrix.size(); i-- > 0;) relax(i);
  for (std::size_t i = level.parent.size(); i < matrix.size(); ++i) relax(i);
}

/// Adds to the solution of level k, after its first sweep, a correction from the next level.
void CellMultigrid::correct_by_next(std::size_t k) {
  Level& level = levels_[k];
  Level& next = levels_[k + 1];
  std::vector<float>& x = level.solution;
  if (!level.is_whole) level.couplings.plan.exchange(x);
  std::vector<float> part(level.cells, 0.0F);
  for (std::size_t i = 0; i < level.parent.size(); ++i) {
    part[level.parent[i]] += level.matrix.sum_right(i, x);  // the sweep has left over what is right of the diagonal
  }
  if (next.gathering) {
    const std::vector<float> all = ranks_.all_gather(part, next.gathering->counts);
    for (std::size_t i = 0; i < all.size(); ++i) next.rhs[next.gathering->row[i]] = all[i];
  } else {
    next.rhs = std::move(part);
  }

  cycle(k + 1);
  if (k + 2 < levels_.size()) {  // once more, for a W
    const std::vector<float> first = next.solution;
    if (!next.is_whole) next.couplings.plan.exchange(next.solution);
    std::vector<float> left(next.matrix.size());
    for (std::size_t i = 0; i < left.size(); ++i) {
      left[i] = next.rhs[i] - next.matrix.diagonal[i] * next.solution[i] + next.matrix.sum_all(i, next.solution);
    }
    next.rhs = std::move(left);
    cycle(k + 1);
    for (std::size_t i = 0; i < next.matrix.size(); ++i) next.solution[i] += first[i];
  }

  const int* row = next.gathering ? next.gathering->row.data() + next.gathering->first_own : nullptr;
  for (std::size_t i = 0; i < level.parent.size(); ++i) {
    const int cell = level.parent[i];
    x[i] += next.solution[row == nullptr ? cell : row[cell]];
  }
}

}  // namespace tailwater
