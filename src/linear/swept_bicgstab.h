// BiCGStab (van der Vorst 1992) preconditioned by SSOR in Eisenstat's form: the solver of nearly every run. PETSc has
// both too, and needs two products more for each of the two solves of a step (docs/theory/linear.md#solving).
#pragma once

#include <span>
#include <vector>

#include "linear/krylov_outcome.h"
#include "linear/triangular_sweeps.h"

namespace tailwater {

/// Borrows the system.
class SweptBicgstab {
 public:
  explicit SweptBicgstab(const LinearSystem& system) : system_(system), sweeps_(system) {}

  /// Improves x, whose b - A x is `residual`, until its norm is `target` or less, or for so many iterations. Breaks
  /// down where it would divide by a number that happens to vanish, or where the residual explodes. Collective.
  KrylovOutcome solve(std::span<const double> residual, double target, int most_iterations, std::span<double> x);

 private:
  const LinearSystem& system_;
  TriangularSweeps sweeps_;
  // All of the preconditioned system (D + L)^-1 A (D + U)^-1 y = (D + L)^-1 r.
  std::vector<double> first_;      ///< residual at the start
  std::vector<double> residual_;   ///< r
  std::vector<double> direction_;  ///< p
  std::vector<double> image_;      ///< v, of p
  std::vector<double> image_of_residual_;
  std::vector<double> solution_;  ///< y
};

}  // namespace tailwater
