#include "linear/shell_solver.h"

#include "base/fp_traps.h"
#include "linear/petsc_vectors.h"

namespace tailwater {
namespace {

/// y = A x, for PETSc. An exception here cannot pass through PETSc and ends the program.
PetscErrorCode multiply_shell(Mat shell, Vec x, Vec y) noexcept {
  ShellSystem* system = nullptr;
  check_petsc(MatShellGetContext(shell, &system));
  const VectorAccess vectors(x, y);
  system->multiply(vectors.from(), vectors.to());
  return 0;
}

/// correction = P residual, for PETSc. An exception ends the program.
PetscErrorCode precondition_shell(PC preconditioner, Vec residual, Vec correction) noexcept {
  ShellSystem* system = nullptr;
  check_petsc(PCShellGetContext(preconditioner, &system));
  const VectorAccess vectors(residual, correction);
  system->precondition(vectors.from(), vectors.to());
  return 0;
}

void set_up(KSP solver, ShellSystem& system, const ShellGoal& goal) {
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner));
  check_petsc(PCSetType(preconditioner, PCSHELL));
  check_petsc(PCShellSetContext(preconditioner, &system));
  check_petsc(PCShellSetApply(preconditioner, precondition_shell));
  check_petsc(KSPSetType(solver, KSPFCG));
  check_petsc(KSPSetNormType(solver, KSP_NORM_NATURAL));
  check_petsc(KSPSetInitialGuessNonzero(solver, PETSC_TRUE));
  check_petsc(KSPConvergedDefaultSetUIRNorm(solver));  // `reduction` is of the residual of the guess
  check_petsc(KSPSetTolerances(solver, goal.reduction, goal.residual, PETSC_DEFAULT, goal.iterations));
}

}  // namespace

ShellReport solve_by_shell(const Communicator& ranks, ShellSystem& system, const ShellGoal& goal,
                           std::span<const double> rhs, std::span<double> x) {
  const SuspendFpTraps suspended;
  need_petsc();
  const auto size = static_cast<PetscInt>(rhs.size());
  PetscMatrix matrix;
  check_petsc(MatCreateShell(ranks.handle(), size, size, PETSC_DETERMINE, PETSC_DETERMINE, &system, matrix.create()));
  check_petsc(MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(multiply_shell)));
  PetscKrylovSolver solver;
  check_petsc(KSPCreate(ranks.handle(), solver.create()));
  set_up(solver.get(), system, goal);
  check_petsc(KSPSetOperators(solver.get(), matrix.get(), matrix.get()));
  PetscVector given;
  PetscVector found;
  wrap(ranks, rhs, given);
  wrap(ranks, x, found);
  check_petsc(KSPSolve(solver.get(), given.get(), found.get()));
  ShellReport report;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check_petsc(KSPGetIterationNumber(solver.get(), &iterations));
  check_petsc(KSPGetConvergedReason(solver.get(), &reason));
  report.iterations = static_cast<int>(iterations);
  report.has_converged = reason > 0;
  return report;
}

}  // namespace tailwater
