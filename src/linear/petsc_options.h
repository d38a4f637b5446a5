// Sets up a PETSc Krylov solver by the choice of solver_choice.h and the user's own options.
#pragma once

#include "linear/petsc.h"
#include "linear/solver_choice.h"

namespace tailwater {

/// Sets type, preconditioner, tolerances and the user's own options of the `solver` of these ranks.
void configure(KSP solver, const PressureSolverTable& settings, const SystemTraits& system, const Communicator& ranks);

/// Hands petsc_options to PETSc. Throws InputError for options that neither the solver of shallow nor that of deep
/// water asks for, because PETSc ignores them silently.
void take_petsc_options(const PressureSolverTable& settings);

}  // namespace tailwater
