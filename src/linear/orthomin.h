// Orthomin (Vinsome 1976) around the multigrid on cells: the generalised conjugate residuals of Eisenstat, Elman &
// Schultz (1983) that forget all but the last directions. Each iteration makes the residual as small as its direction
// can, and the images of the directions that are kept are orthogonal to each other. It allows for a preconditioner that
// is slightly nonlinear by rounding, as FGMRES does. With a good one it needs hardly more iterations, and at most six
// pairs of vectors instead of one for each iteration (docs/theory/linear.md).
#pragma once

#include <span>
#include <vector>

#include "linear/cell_multigrid.h"
#include "linear/krylov_outcome.h"

namespace tailwater {

/// Borrows both.
class Orthomin {
 public:
  Orthomin(const LinearSystem& system, CellMultigrid& multigrid) : system_(system), multigrid_(multigrid) {}

  /// Improves x, whose b - A x is `residual`, until its norm is `target` or less, or for so many iterations. Changes
  /// `residual` to that of the new x. Collective.
  KrylovOutcome solve(std::span<double> residual, double target, int most_iterations, std::span<double> x);

 private:
  struct Direction {
    std::vector<double> step;   ///< with ghosts behind it
    std::vector<double> image;  ///< A step
    double square = 0.0;        ///< of the image's norm
  };

  void make_orthogonal(Direction& direction) const;

  const LinearSystem& system_;
  CellMultigrid& multigrid_;
  std::vector<Direction> kept_;  ///< in no order
};

}  // namespace tailwater
