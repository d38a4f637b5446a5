// BiCGStab (van der Vorst 1992) preconditioned by SSOR in Eisenstat's form: the solver of nearly every run. PETSc has
// both too, and needs two products more for each of the two solves of a step (docs/theory/linear.md#solving).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "linear/triangular_sweeps.h"

namespace tailwater {

/// Borrows the system.
class SweptBicgstab {
 public:
  explicit SweptBicgstab(const LinearSystem& system) : system_(system), sweeps_(system) {}

  struct Outcome {
    int iterations = 0;
    bool broke_down = false;  ///< it would have divided by a number that happened to vanish, or the residual exploded
    double residual = 0.0;    ///< norm of b - A x
  };

  /// Improves x, whose b - A x is `residual`, until its norm is `target` or less, or for so many iterations.
  /// Collective.
  Outcome solve(std::span<const double> residual, double target, int most_iterations, std::span<double> x);

  /// Norms of the residual in the last solve, estimated from those of the preconditioned one; the first is the start's.
  const std::vector<double>& history() const { return history_; }

 private:
  const LinearSystem& system_;
  TriangularSweeps sweeps_;
  std::vector<double> history_;
  // All of the preconditioned system (D + L)^-1 A (D + U)^-1 y = (D + L)^-1 r.
  std::vector<double> first_;      ///< residual at the start
  std::vector<double> residual_;   ///< r
  std::vector<double> direction_;  ///< p
  std::vector<double> image_;      ///< v, of p
  std::vector<double> image_of_residual_;
  std::vector<double> solution_;  ///< y
};

}  // namespace tailwater
