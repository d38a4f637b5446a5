#include "linear/solver_choice.h"

namespace tailwater {
namespace {

/// Rows of particles from which the multigrid is faster. The iterations of SSOR grow with the distance to the surface,
/// where p = 0; the cost of both per unknown does not depend on their number. In 2D the set-up of the multigrid pays
/// from 40 rows on for two solves (39, less the effect of jitter), and from 25 for three. In 3D, where a cycle costs
/// less than a product, it pays from some 12 (docs/theory/linear.md#the-choice-of-method).
double multigrid_pays_from(const SystemTraits& system) {
  if (system.dimension == 3) return 12.0;
  return system.solves > 2 ? 25.0 : 39.0;
}

PreconditionerName fastest_preconditioner(const SystemTraits& system) {
  if (system.rows_deep < multigrid_pays_from(system)) return PreconditionerName::ssor;
  return system.has_cells ? PreconditionerName::cell_multigrid : PreconditionerName::boomeramg;
}

/// With a good preconditioner, which needs few iterations, GMRES needs the fewest. Many iterations are cheaper with
/// BiCGStab, which does not orthogonalise. FGMRES allows for the single precision of the multigrid on cells. So does
/// our own Orthomin, which replaces FGMRES where neither the case nor petsc_options name a method (linear_solver.cpp).
KrylovMethod fastest_method(PreconditionerName preconditioner) {
  switch (preconditioner) {
    case PreconditionerName::cell_multigrid:
      return KrylovMethod::fgmres;
    case PreconditionerName::boomeramg:
    case PreconditionerName::gamg:
      return KrylovMethod::gmres;
    default:
      return KrylovMethod::bicgstab;
  }
}

}  // namespace

SystemTraits traits_of(const LinearSystem& system, SystemTraits water) {
  water.constant_is_free = system.constant_is_free();
  water.has_cells = system.has_cells();
  return water;
}

SolverChoice choose_solver(const PressureSolverTable& settings, const SystemTraits& system) {
  SolverChoice choice{settings.method, settings.preconditioner};
  if (choice.preconditioner == PreconditionerName::automatic) choice.preconditioner = fastest_preconditioner(system);
  if (choice.method == KrylovMethod::automatic) choice.method = fastest_method(choice.preconditioner);
  return choice;
}

}  // namespace tailwater
