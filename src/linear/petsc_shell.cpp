#include "linear/petsc_shell.h"

namespace tailwater {
namespace {

/// y = A x, for PETSc.
PetscErrorCode multiply_shell(Mat shell, Vec x, Vec y) noexcept {
  ShellSystem* system = nullptr;
  check_petsc(MatShellGetContext(shell, &system));
  const VectorAccess vectors(x, y);
  system->multiply(vectors.from(), vectors.to());
  return 0;
}

/// correction = P residual, for PETSc.
PetscErrorCode precondition_shell(PC preconditioner, Vec residual, Vec correction) noexcept {
  ShellSystem* system = nullptr;
  check_petsc(PCShellGetContext(preconditioner, &system));
  const VectorAccess vectors(residual, correction);
  system->precondition(vectors.from(), vectors.to());
  return 0;
}

}  // namespace

void make_shell(const Communicator& ranks, ShellSystem& system, std::size_t size, PetscMatrix& matrix) {
  const auto rows = static_cast<PetscInt>(size);
  check_petsc(MatCreateShell(ranks.handle(), rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, &system, matrix.create()));
  check_petsc(MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply_shell)));
}

void attach_shell(PC preconditioner, ShellSystem& system) {
  check_petsc(PCShellSetContext(preconditioner, &system));
  check_petsc(PCShellSetApply(preconditioner, precondition_shell));
}

}  // namespace tailwater
