#include "linear/cell_multigrid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/assert.h"

namespace tailwater {

using multigrid::Entry;
using multigrid::Level;
using multigrid::Matrix;

namespace {

/// Maximum number of rows of the level that is solved directly.
constexpr std::size_t coarsest_rows = 32;

/// Pivots of the coarsest level below this fraction of the largest are rounding: a constant is free.
constexpr double vanishing_pivot = 1e-6;

/// Values of the solution below this, where the largest of the right-hand side is 1, become 0. They arise far from any
/// source and would soon leave the range of normal numbers, which slows processors down.
constexpr float vanishing_value = 1e-20F;

/// Levels behind the first that follow changes of its rows without a new set-up.
constexpr std::size_t held_levels = 2;

float settled(float value) { return std::abs(value) < vanishing_value ? 0.0F : value; }

/// Gauss-Seidel from x = 0, first row to last: the unknowns behind a row are still 0.
void sweep_forward(Level& level) {
  const Matrix& matrix = level.matrix;
  std::vector<float>& x = level.solution;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    x[i] = settled(matrix.inverse[i] * (level.rhs[i] + matrix.sum_left(i, x)));
  }
}

/// Gauss-Seidel from last row to first, and a second pass over the rows that follow from others once those are known.
void sweep_back(Level& level) {
  const Matrix& matrix = level.matrix;
  std::vector<float>& x = level.solution;
  const auto relax = [&](std::size_t i) { x[i] = settled(matrix.inverse[i] * (level.rhs[i] + matrix.sum_all(i, x))); };
  level.exchange(x);
  for (std::size_t i = matrix.size(); i-- > 0;) relax(i);
  for (std::size_t i = level.parent.size(); i < matrix.size(); ++i) relax(i);
}

/// Each row of a cell gets the correction of the cell.
void add_correction(const Level& next, Level& level) {
  const int* row = next.gathering ? next.gathering->row.data() + next.gathering->first_own : nullptr;
  for (std::size_t i = 0; i < level.parent.size(); ++i) {
    const int cell = level.parent[i];
    level.solution[i] += next.solution[row == nullptr ? cell : row[cell]];
  }
}

}  // namespace

CellMultigrid::CellMultigrid(const LinearSystem& system)
    : ranks_(system.ranks()), constant_is_free_(system.constant_is_free()) {
  TAILWATER_ASSERT(system.cells().number.size() == system.size(), "a multigrid on cells needs the cell of each row");
  multigrid::FirstLevel first = multigrid::first_level(system);
  row_ = std::move(first.row);
  scale_ = std::move(first.scale);
  levels_.push_back(std::move(first.level));
  do {
    levels_.push_back(multigrid::next_level(levels_.back(), system.cells().dimension, ranks_));
  } while (!levels_.back().is_whole || levels_.back().matrix.size() > coarsest_rows);
  invert_coarsest();
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

/// Solves level k approximately, from x = 0.
void CellMultigrid::cycle(std::size_t k) {
  if (k + 1 == levels_.size()) return solve_coarsest();
  Level& level = levels_[k];
  Level& next = levels_[k + 1];
  sweep_forward(level);
  sum_residual_by_cells(level, next);
  cycle(k + 1);
  if (k + 2 < levels_.size()) cycle_again(k + 1);  // which makes it a W cycle
  add_correction(next, level);
  sweep_back(level);
}

/// Solves level k approximately for the residual of the previous cycle, and adds the result to the solution.
void CellMultigrid::cycle_again(std::size_t k) {
  Level& level = levels_[k];
  const Matrix& matrix = level.matrix;
  const std::vector<float> first = level.solution;
  level.exchange(level.solution);
  std::vector<float> left(matrix.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    left[i] = level.rhs[i] - matrix.diagonal[i] * level.solution[i] + matrix.sum_all(i, level.solution);
  }
  level.rhs = std::move(left);
  cycle(k);
  for (std::size_t i = 0; i < matrix.size(); ++i) level.solution[i] += first[i];
}

/// The right-hand side of the next level. After a sweep forward the residual of a row is its part right of the
/// diagonal.
void CellMultigrid::sum_residual_by_cells(Level& level, Level& next) const {
  std::vector<float>& x = level.solution;
  level.exchange(x);
  std::vector<float> part(level.cells, 0.0F);
  for (std::size_t i = 0; i < level.parent.size(); ++i) part[level.parent[i]] += level.matrix.sum_right(i, x);
  if (!next.gathering) {
    next.rhs = std::move(part);
    return;
  }
  const std::vector<float> all = ranks_.all_gather(part, next.gathering->counts);
  for (std::size_t i = 0; i < all.size(); ++i) next.rhs[next.gathering->row[i]] = all[i];
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

void CellMultigrid::solve_coarsest() {
  using Vector = Eigen::Map<Eigen::VectorXf>;
  Level& level = levels_.back();
  const auto size = static_cast<Eigen::Index>(level.solution.size());
  Vector(level.solution.data(), size).noalias() = coarsest_inverse_ * Vector(level.rhs.data(), size);
}

bool CellMultigrid::follow(const LinearSystem& system) {
  bool has_changed = false;
  Matrix& matrix = levels_.front().matrix;
  for (std::size_t i = 0; i < row_.size(); ++i) {
    const auto scale = static_cast<float>(system.scale(row_[i]));
    if (scale == scale_[i] || scale_[i] == 0.0F) continue;
    const float share = scale / scale_[i];
    float lost = 0.0F;  // reduction of the row's weights
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

/// After the weights of row i of the first level have decreased: raises the diagonals of its cells on the next levels.
/// The rows of those levels keep their weights, so the raised diagonals keep the row sums right.
void CellMultigrid::hold_cells(std::size_t i, float lost) {
  for (std::size_t k = 0; k < held_levels && k + 1 < levels_.size(); ++k) {
    if (i >= levels_[k].parent.size() || levels_[k + 1].gathering) return;
    i = levels_[k].parent[i];
    lost /= static_cast<float>(multigrid::over_correction);
    Matrix& matrix = levels_[k + 1].matrix;
    matrix.diagonal[i] += lost;
    matrix.inverse[i] = 1.0F / matrix.diagonal[i];
  }
}

}  // namespace tailwater
