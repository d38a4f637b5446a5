// A PETSc Krylov solver, set up as the choice and the user's own options ask.
#pragma once

#include "linear/petsc.h"
#include "linear/solver_choice.h"

namespace tailwater {

/// Sets type, preconditioner, tolerances and the user's own options of `solver` for such a system on so many ranks.
void configure(KSP solver, const PressureSolverTable& settings, const SystemTraits& system, bool is_alone);

/// Hands petsc_options to PETSc. Throws InputError for options that neither the solver of shallow nor that of deep water
/// asks for: PETSc itself ignores them in silence.
void take_petsc_options(const PressureSolverTable& settings);

}  // namespace tailwater
