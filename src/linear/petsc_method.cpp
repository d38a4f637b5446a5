#include "linear/petsc_method.h"

#include <fmt/format.h>

#include "linear/petsc_shell.h"

namespace tailwater {
namespace {

/// Whether the method divided by a number that happened to vanish, or diverged. Slow convergence is no breakdown.
bool is_breakdown(KSPConvergedReason reason) {
  return reason == KSP_DIVERGED_BREAKDOWN || reason == KSP_DIVERGED_BREAKDOWN_BICG || reason == KSP_DIVERGED_DTOL ||
         reason == KSP_DIVERGED_NANORINF;
}

MethodOutcome::End end_of(KSPConvergedReason reason) {
  if (reason > 0) return MethodOutcome::End::converged;
  return is_breakdown(reason) ? MethodOutcome::End::broke_down : MethodOutcome::End::unfinished;
}

/// The outcome of the solver.
MethodOutcome outcome_of(KSP solver) {
  KSPType type = nullptr;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  const char* reason_name = nullptr;
  PetscInt iterations = 0;
  const PetscReal* history = nullptr;
  PetscInt length = 0;
  check_petsc(KSPGetType(solver, &type));
  check_petsc(KSPGetConvergedReason(solver, &reason));
  check_petsc(KSPGetConvergedReasonString(solver, &reason_name));
  check_petsc(KSPGetIterationNumber(solver, &iterations));
  check_petsc(KSPGetResidualHistory(solver, &history, &length));
  return {.end = end_of(reason),
          .reason = fmt::format("PETSc's {} ended with {}", type, reason_name),
          .iterations = static_cast<int>(iterations),
          .history = {history, history + length}};
}

}  // namespace

void PetscMethod::Shell::multiply(std::span<const double> x, std::span<double> y) {
  std::vector<double> with_ghosts(x.begin(), x.end());
  system->multiply(with_ghosts, y);
}

void PetscMethod::Shell::precondition(std::span<const double> residual, std::span<double> correction) {
  multigrid->apply(residual, correction);
}

MethodOutcome PetscMethod::improve(const LinearSystem& system, const Goal& goal, Iterate& iterate) {
  if (!is_set_up_) set_up(system);
  wrap(system.ranks(), system.rhs(), rhs_);
  wrap(system.ranks(), iterate.x, solution_);
  check_petsc(KSPSetTolerances(solver_.get(), goal.tolerance, PETSC_DEFAULT, PETSC_DEFAULT, goal.iterations));
  check_petsc(KSPSolve(solver_.get(), rhs_.get(), solution_.get()));
  return outcome_of(solver_.get());
}

void PetscMethod::change_to_gmres(const LinearSystem& system) {
  set_up(system);
  check_petsc(KSPSetType(solver_.get(), KSPGMRES));
  solver_size_.reset();
}

/// Prepares the solver for this solve. A new pattern gets a new solver, because multigrid would reuse the bounds of the
/// spectrum of the old pattern. A run that resumes from a checkpoint has no old pattern.
void PetscMethod::set_up(const LinearSystem& system) {
  need_petsc();
  const bool pattern_is_new = take_matrix(system);
  const Communicator& ranks = system.ranks();
  if (ranks.any(pattern_is_new || solver_size_ != system.size())) {
    check_petsc(KSPCreate(ranks.handle(), solver_.create()));
    solver_size_ = system.size();
    configure(solver_.get(), settings_, traits_of(system, water_), ranks);
  }
  wrap_multigrid(system);
  // While the pattern is the same the rows change little, and setting up multigrid costs as much as a solve.
  check_petsc(KSPSetReusePreconditioner(solver_.get(), pattern_is_new ? PETSC_FALSE : PETSC_TRUE));
  if (!works_on_shell()) rows_.take(system);
  const Mat rows = works_on_shell() ? matrix_.get() : rows_.get();
  if (constants_.get() != nullptr) check_petsc(MatSetNullSpace(rows, constants_.get()));
  check_petsc(KSPSetOperators(solver_.get(), rows, rows));
  is_set_up_ = true;
}

/// Attaches the shell to the system. Returns whether the pattern is new.
bool PetscMethod::take_matrix(const LinearSystem& system) {
  shell_.system = &system;
  if (pattern_number_ == system.pattern_number()) return false;
  pattern_number_ = system.pattern_number();
  make_shell(system.ranks(), shell_, system.size(), matrix_);
  if (system.constant_is_free()) {
    check_petsc(MatNullSpaceCreate(system.ranks().handle(), PETSC_TRUE, 0, nullptr, constants_.create()));
  }
  return true;
}

/// Whether the preconditioner needs only products with the system.
bool PetscMethod::works_on_shell() const {
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver_.get(), &preconditioner));
  const auto is_one = [&](PCType type) {
    PetscBool is_so = PETSC_FALSE;
    check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), type, &is_so));
    return is_so == PETSC_TRUE;
  };
  return is_one(PCSHELL) || is_one(PCNONE);
}

/// Makes our own multigrid the preconditioner if that is the choice.
void PetscMethod::wrap_multigrid(const LinearSystem& system) {
  PC preconditioner = nullptr;
  PetscBool is_ours = PETSC_FALSE;
  check_petsc(KSPGetPC(solver_.get(), &preconditioner));
  check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCSHELL, &is_ours));
  if (!is_ours || !system.has_cells()) return;
  multigrid_.take(system, 0.0);
  shell_.multigrid = &multigrid_.get();
  attach_shell(preconditioner, shell_);
}

}  // namespace tailwater
