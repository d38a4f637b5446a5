#include "linear/solver_choice.h"

namespace tailwater {
namespace {

/// Rows of particles. In water less deep SSOR with BiCGStab costs less than algebraic multigrid with its set-up
/// (docs/theory/linear.md gives the measurement): its iterations grow with the way to the surface, where p = 0, and the
/// cost of both per unknown does not depend on their number.
constexpr double multigrid_pays_from = 150.0;

}  // namespace

SolverChoice choose_solver(const PressureSolverTable& settings, const SystemTraits& system) {
  const bool is_shallow = system.rows_deep < multigrid_pays_from;
  SolverChoice choice{settings.method, settings.preconditioner};
  if (choice.method == KrylovMethod::automatic) {
    choice.method = is_shallow ? KrylovMethod::bicgstab : KrylovMethod::gmres;
  }
  if (choice.preconditioner == PreconditionerName::automatic) {
    choice.preconditioner = is_shallow ? PreconditionerName::ssor : PreconditionerName::boomeramg;
  }
  return choice;
}

}  // namespace tailwater
