#include "linear/solver_choice.h"

namespace tailwater {
namespace {

/// Below this many unknowns SSOR with BiCGStab costs less than algebraic multigrid with its set-up
/// (docs/theory/linear.md gives the measurement).
constexpr std::int64_t multigrid_pays_from = 40000;

}  // namespace

SolverChoice choose_solver(const PressureSolverTable& settings, const SystemTraits& system) {
  const bool is_small = system.unknowns < multigrid_pays_from;
  SolverChoice choice{settings.method, settings.preconditioner};
  if (choice.method == KrylovMethod::automatic) {
    choice.method = is_small ? KrylovMethod::bicgstab : KrylovMethod::gmres;
  }
  if (choice.preconditioner == PreconditionerName::automatic) {
    choice.preconditioner = is_small ? PreconditionerName::ssor : PreconditionerName::boomeramg;
  }
  return choice;
}

}  // namespace tailwater
