// A multigrid for matrices of particles. The unknowns of a background cell, two particles wide, move as one on the next
// level. Those of 2^Dim cells move as one on the level after that, and so on down to a few unknowns, which are solved
// for directly. Each matrix is the Galerkin product of the one before. Corrections that are constant in a cell are too
// small by about the same factor everywhere, and the matrix compensates for this factor (Braess 1995). W cycles, with
// one Gauss-Seidel sweep from the first row to the last before the correction and one back after it.
//
// Numbers are in single precision, which is enough for a preconditioner. Gauss-Seidel runs over each rank's own rows;
// unknowns of other ranks keep their values from the last exchange. Cells do not span ranks until few are left. Then
// all ranks have the whole level and need no further messages. docs/theory/linear.md has the measurements.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "linear/linear_system.h"
#include "linear/multigrid_level.h"

namespace tailwater {

class CellMultigrid {
 public:
  /// For a system with cells. Collective.
  explicit CellMultigrid(const LinearSystem& system);

  /// Adopts the changes of LinearSystem::divide_diagonal since the last call, and returns whether there are any. Only
  /// the first level follows, which is enough for a few rows near the surface (docs/theory/linear.md).
  bool follow(const LinearSystem& system);

  /// correction = an approximation of A^-1 residual. Collective.
  void apply(std::span<const double> residual, std::span<double> correction);

 private:
  void cycle(std::size_t k);
  void cycle_again(std::size_t k);
  void sum_residual_by_cells(multigrid::Level& level, multigrid::Level& next) const;
  void invert_coarsest();
  void solve_coarsest();
  void hold_cells(std::size_t i, float lost);

  Communicator ranks_;
  bool constant_is_free_;
  std::vector<int> row_;      ///< row of the system, for each row of the first level
  std::vector<float> scale_;  ///< scale of that row
  std::vector<multigrid::Level> levels_;
  Eigen::MatrixXf coarsest_inverse_;
};

}  // namespace tailwater
