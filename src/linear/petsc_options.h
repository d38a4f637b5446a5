// Sets up a PETSc Krylov solver from the choice of solver_choice.h and the user's own options.
#pragma once

#include "linear/petsc.h"
#include "linear/solver_choice.h"

namespace tailwater {

/// Sets type, preconditioner, tolerances and the user's own options of the `solver` of these ranks.
void configure(KSP solver, const PressureSolverTable& settings, const SystemTraits& system, const Communicator& ranks);

/// Passes petsc_options to PETSc. Throws InputError for options that neither the solver of shallow nor that of deep
/// water queries, because PETSc ignores them silently.
void take_petsc_options(const PressureSolverTable& settings);

}  // namespace tailwater
