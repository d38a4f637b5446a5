#include "linear/shell_solver.h"

#include "base/fp_traps.h"
#include "linear/petsc_shell.h"

namespace tailwater {
namespace {

/// Directions with memory from the start, which PETSc fills with zeros. It adds more where they are needed.
constexpr int directions_at_first = 3;

void set_up(KSP solver, ShellSystem& system, const ShellGoal& goal) {
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner));
  check_petsc(PCSetType(preconditioner, PCSHELL));
  attach_shell(preconditioner, system);
  check_petsc(KSPSetType(solver, KSPFCG));
  check_petsc(KSPFCGSetNprealloc(solver, directions_at_first));
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
  PetscMatrix matrix;
  make_shell(ranks, system, rhs.size(), matrix);
  PetscKrylovSolver solver;
  check_petsc(KSPCreate(ranks.handle(), solver.create()));
  set_up(solver.get(), system, goal);
  check_petsc(KSPSetOperators(solver.get(), matrix.get(), matrix.get()));
  PetscVector given;
  PetscVector found;
  wrap(ranks, rhs, given);
  wrap(ranks, x, found);
  ShellReport report;
  check_petsc(KSPSetResidualHistory(solver.get(), &report.first_residual, 1, PETSC_TRUE));
  check_petsc(KSPSolve(solver.get(), given.get(), found.get()));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check_petsc(KSPGetIterationNumber(solver.get(), &iterations));
  check_petsc(KSPGetConvergedReason(solver.get(), &reason));
  report.iterations = static_cast<int>(iterations);
  report.has_converged = reason > 0;
  return report;
}

}  // namespace tailwater
