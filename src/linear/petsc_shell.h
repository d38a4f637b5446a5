// Matrices and preconditioners of PETSc that call a ShellSystem. An exception in it cannot pass through PETSc and ends
// the program.
#pragma once

#include "linear/petsc_vectors.h"
#include "linear/shell_solver.h"

namespace tailwater {

/// Makes `matrix` multiply by a system of `size` unknowns on this rank. Collective.
void make_shell(const Communicator& ranks, ShellSystem& system, std::size_t size, PetscMatrix& matrix);

/// Makes a preconditioner of the type PCSHELL call the system.
void attach_shell(PC preconditioner, ShellSystem& system);

}  // namespace tailwater
