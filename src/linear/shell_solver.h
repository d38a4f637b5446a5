// Conjugate gradients of PETSc for a symmetric, positive system that is known only by its products, with a
// preconditioner that need not be exactly symmetric, such as a multigrid in single precision. The flexible variant
// (Notay 2000) allows for that.
#pragma once

#include <span>

#include "parallel/communicator.h"

namespace tailwater {

/// The unknowns are numbers of this rank.
class ShellSystem {
 public:
  virtual ~ShellSystem() = default;
  /// y = A x. Collective.
  virtual void multiply(std::span<const double> x, std::span<double> y) = 0;
  /// An approximate solution of A correction = residual. Collective.
  virtual void precondition(std::span<const double> residual, std::span<double> correction) = 0;
};

/// When a solve ends, in the natural norm sqrt(r . P r) of the residual r with the preconditioner P: about the energy
/// norm of the error.
struct ShellGoal {
  double residual;   ///< in that norm
  double reduction;  ///< or this fraction of the residual of the guess
  int iterations;    ///< or so many iterations
};

struct ShellReport {
  int iterations = 0;
  double first_residual = 0.0;  ///< of the guess, in the norm of the goal
  bool has_converged = false;
};

/// `x` has the guess. Collective.
ShellReport solve_by_shell(const Communicator& ranks, ShellSystem& system, const ShellGoal& goal,
                           std::span<const double> rhs, std::span<double> x);

}  // namespace tailwater
