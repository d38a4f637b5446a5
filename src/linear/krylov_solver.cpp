#include "linear/krylov_solver.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/assert.h"
#include "base/error.h"
#include "base/fp_traps.h"
#include "linear/cell_multigrid.h"
#include "linear/dot.h"
#include "linear/orthomin.h"
#include "linear/petsc_rows.h"
#include "linear/petsc_solver.h"
#include "linear/swept_bicgstab.h"

namespace tailwater {
namespace {

/// Below this norm of the right-hand side the answer is zero pressure: nothing drives it, and squares soon underflow.
constexpr double vanishing_rhs = 1e-100;

/// PETSc gives up on a guess whose residual is 1e5 times the source. Below that a guess helps even if its residual is
/// larger than that of 0: its error is rough, and rough errors are smoothed away first.
constexpr double hopeless_guess = 1e4;

/// Whether the method divided by a number that happened to vanish. Slow convergence is no breakdown.
bool is_breakdown(KSPConvergedReason reason) {
  return reason == KSP_DIVERGED_BREAKDOWN || reason == KSP_DIVERGED_BREAKDOWN_BICG || reason == KSP_DIVERGED_DTOL ||
         reason == KSP_DIVERGED_NANORINF;
}

/// The entries of two of PETSc's vectors, as long as it lives.
class VectorAccess {
 public:
  VectorAccess(Vec from, Vec to) : from_(from), to_(to) {
    check_petsc(VecGetLocalSize(from, &size_));
    check_petsc(VecGetArrayRead(from, &read_));
    check_petsc(VecGetArrayWrite(to, &written_));
  }
  ~VectorAccess() {
    VecRestoreArrayWrite(to_, &written_);
    VecRestoreArrayRead(from_, &read_);
  }
  VectorAccess(const VectorAccess&) = delete;
  VectorAccess& operator=(const VectorAccess&) = delete;

  std::span<const double> from() const { return {read_, static_cast<std::size_t>(size_)}; }
  std::span<double> to() const { return {written_, static_cast<std::size_t>(size_)}; }

 private:
  Vec from_;
  Vec to_;
  PetscInt size_ = 0;
  const PetscScalar* read_ = nullptr;
  PetscScalar* written_ = nullptr;
};

/// y = A x, for PETSc. An exception here has no way out through PETSc and ends the program.
PetscErrorCode apply_system(Mat shell, Vec x, Vec y) noexcept {
  const LinearSystem* system = nullptr;
  check_petsc(MatShellGetContext(shell, &system));
  const VectorAccess vectors(x, y);
  std::vector<double> from(vectors.from().begin(), vectors.from().end());
  system->multiply(from, vectors.to());
  return 0;
}

/// correction = multigrid(residual), the same.
PetscErrorCode apply_multigrid(PC preconditioner, Vec residual, Vec correction) noexcept {
  CellMultigrid* multigrid = nullptr;
  check_petsc(PCShellGetContext(preconditioner, &multigrid));
  const VectorAccess vectors(residual, correction);
  multigrid->apply(vectors.from(), vectors.to());
  return 0;
}

/// Makes a PETSc vector that shares `values`.
void wrap(const Communicator& ranks, std::span<double> values, PetscVector& vector) {
  const auto rows = static_cast<PetscInt>(values.size());
  check_petsc(ranks.is_alone()
                  ? VecCreateSeqWithArray(PETSC_COMM_SELF, 1, rows, values.data(), vector.create())
                  : VecCreateMPIWithArray(ranks.handle(), 1, rows, PETSC_DETERMINE, values.data(), vector.create()));
}

/// Below this tolerance rounding may show in the residual that our own methods keep, and it is computed from x.
constexpr double least_sure_tolerance = 1e-7;

SystemTraits traits_of(const LinearSystem& system, SystemTraits water) {
  water.constant_is_free = system.constant_is_free();
  water.has_cells = system.has_cells();
  return water;
}

/// Relative residual above which a multigrid that has followed its system is set up anew. To reach 1e-4 from there it
/// would take three times as many iterations as a new one (docs/theory/linear.md#the-multigrid-on-cells).
constexpr double most_to_follow = 0.1;

enum class Implementation { swept_bicgstab, orthomin, petsc };

/// Our own methods serve what the rule chooses. Options go to PETSc, and so do systems with a free constant and SSOR.
Implementation implementation_for(const PressureSolverTable& settings, const SystemTraits& water,
                                  const LinearSystem& system) {
  if (!settings.petsc_options.empty()) return Implementation::petsc;
  const SolverChoice choice = choose_solver(settings, traits_of(system, water));
  if (choice.preconditioner == PreconditionerName::cell_multigrid) {
    return settings.method == KrylovMethod::automatic && system.has_cells() ? Implementation::orthomin
                                                                            : Implementation::petsc;
  }
  const bool is_swept = choice.method == KrylovMethod::bicgstab && choice.preconditioner == PreconditionerName::ssor;
  return is_swept && !system.constant_is_free() ? Implementation::swept_bicgstab : Implementation::petsc;
}

/// One run of a Krylov method.
struct Attempt {
  KSPConvergedReason reason = KSP_CONVERGED_RTOL;
  int iterations = 0;
  std::optional<double> residual = {};  ///< norm of b - A x, if the method knows it
  std::vector<double> history;          ///< of residuals, in any unit
};

/// About twelve residuals of the history, scaled so that the first is `first`.
std::vector<double> shown_residuals(const std::vector<double>& history, double first) {
  std::vector<double> shown;
  const std::size_t stride = std::max<std::size_t>(1, history.size() / 12);
  for (std::size_t k = 0; k < history.size(); k += stride) shown.push_back(first * history[k] / history[0]);
  return shown;
}

/// b - A x. Collective.
std::vector<double> residual_of(const LinearSystem& system, std::span<const double> x) {
  std::vector<double> residual(x.size());
  std::vector<double> with_ghosts(x.begin(), x.end());
  system.multiply(with_ghosts, residual);
  for (std::size_t i = 0; i < x.size(); ++i) residual[i] = system.rhs()[i] - residual[i];
  return residual;
}

double norm_of(const Communicator& ranks, std::span<const double> x) { return std::sqrt(ranks.sum(dot(x, x))); }

/// An attempt by a method of our own.
Attempt attempt_of(KrylovOutcome outcome, double target) {
  Attempt attempt{.iterations = outcome.iterations, .history = std::move(outcome.history)};
  if (outcome.broke_down) {
    attempt.reason = KSP_DIVERGED_BREAKDOWN;
  } else {
    attempt.residual = outcome.residual;
    if (outcome.residual > target) attempt.reason = KSP_DIVERGED_ITS;
  }
  return attempt;
}

}  // namespace

/// PETSc's objects and the multigrid, and the system they belong to.
struct KrylovSolver::Petsc {
  PetscMatrix matrix;  ///< a shell around the system
  PetscRows rows;      ///< only for preconditioners that need them
  PetscVector rhs;
  PetscVector solution;
  PetscKrylovSolver solver;
  PetscNullSpace constants;
  std::optional<CellMultigrid> multigrid;
  std::uint64_t pattern_number = 0;        ///< of the matrix
  std::uint64_t multigrid_number = 0;      ///< of the pattern for which the multigrid was set up
  std::optional<std::size_t> solver_size;  ///< rows of this rank; none after a restart with another method

  /// Returns whether the pattern is new.
  bool take_matrix(const LinearSystem& system) {
    if (pattern_number == system.pattern_number()) return false;
    pattern_number = system.pattern_number();
    const auto size = static_cast<PetscInt>(system.size());
    check_petsc(MatCreateShell(system.ranks().handle(), size, size, PETSC_DETERMINE, PETSC_DETERMINE,
                               const_cast<LinearSystem*>(&system), matrix.create()));
    check_petsc(MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<void (*)()>(apply_system)));
    if (system.constant_is_free()) {
      check_petsc(MatNullSpaceCreate(system.ranks().handle(), PETSC_TRUE, 0, nullptr, constants.create()));
      check_petsc(MatSetNullSpace(matrix.get(), constants.get()));
    }
    return true;
  }

  /// Prepares for attempts. A solver is made anew for a new pattern: multigrid would carry bounds of the spectrum over
  /// from the old one, and a run that goes on from a checkpoint has no old one.
  void take(LinearSystem& system, const PressureSolverTable& settings, const SystemTraits& water) {
    const bool pattern_is_new = take_matrix(system);
    const Communicator& ranks = system.ranks();
    if (ranks.any(pattern_is_new || solver_size != system.size())) {
      check_petsc(KSPCreate(ranks.handle(), solver.create()));
      solver_size = system.size();
      configure(solver.get(), settings, traits_of(system, water), ranks.is_alone());
    }
    wrap_multigrid(system);
    // While the pattern is the same the rows change little, and setting up multigrid costs as much as a solve.
    check_petsc(KSPSetReusePreconditioner(solver.get(), pattern_is_new ? PETSC_FALSE : PETSC_TRUE));
    if (is_ours()) {
      check_petsc(KSPSetOperators(solver.get(), matrix.get(), matrix.get()));
      return;
    }
    rows.take(system);
    if (constants.get() != nullptr) check_petsc(MatSetNullSpace(rows.get(), constants.get()));
    check_petsc(KSPSetOperators(solver.get(), rows.get(), rows.get()));
  }

  /// Whether the preconditioner works on the system's own rows.
  bool is_ours() const {
    PC preconditioner = nullptr;
    PetscBool is_one = PETSC_FALSE;
    check_petsc(KSPGetPC(solver.get(), &preconditioner));
    check_petsc(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(preconditioner), &is_one, PCSHELL, PCNONE, ""));
    return is_one;
  }

  /// Our own multigrid for a solve that begins with this residual, set up if the pattern is new. Otherwise it follows
  /// what has changed, unless that has brought back most of the residual: then a new one pays.
  CellMultigrid& multigrid_for(LinearSystem& system, double residual) {
    const bool is_new = !multigrid || multigrid_number != system.pattern_number();
    if (system.ranks().any(is_new || (multigrid->follow(system) && residual > most_to_follow))) {
      multigrid.emplace(system);
      multigrid_number = system.pattern_number();
    }
    return *multigrid;
  }

  /// Gives our own multigrid to PETSc's solver if that is to have it.
  void wrap_multigrid(LinearSystem& system) {
    PC preconditioner = nullptr;
    PetscBool is_ours = PETSC_FALSE;
    check_petsc(KSPGetPC(solver.get(), &preconditioner));
    check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCSHELL, &is_ours));
    if (!is_ours || !system.has_cells()) return;
    check_petsc(PCShellSetContext(preconditioner, &multigrid_for(system, 0.0)));
    check_petsc(PCShellSetApply(preconditioner, apply_multigrid));
  }

  /// The next attempts of this solve are by GMRES; the next solve uses the method of the settings again.
  void change_method() {
    check_petsc(KSPSetType(solver.get(), KSPGMRES));
    solver_size.reset();
  }

  /// Goes on from x until the preconditioned residual is `tolerance` of the right-hand side.
  Attempt attempt(LinearSystem& system, double tolerance, std::span<double> x) {
    wrap(system.ranks(), system.rhs(), rhs);
    wrap(system.ranks(), x, solution);
    check_petsc(KSPSetTolerances(solver.get(), tolerance, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
    check_petsc(KSPSolve(solver.get(), rhs.get(), solution.get()));
    Attempt attempt;
    PetscInt iterations = 0;
    check_petsc(KSPGetIterationNumber(solver.get(), &iterations));
    check_petsc(KSPGetConvergedReason(solver.get(), &attempt.reason));
    attempt.iterations = static_cast<int>(iterations);
    const PetscReal* history = nullptr;
    PetscInt length = 0;
    check_petsc(KSPGetResidualHistory(solver.get(), &history, &length));
    attempt.history.assign(history, history + length);
    return attempt;
  }
};

KrylovSolver::KrylovSolver(const PressureSolverTable& settings, const SystemTraits& water)
    : settings_(settings), water_(water), petsc_(std::make_unique<Petsc>()) {
  take_petsc_options(settings_);
}

bool KrylovSolver::needs_cells() const {
  SystemTraits system = water_;
  system.has_cells = true;
  return choose_solver(settings_, system).preconditioner == PreconditionerName::cell_multigrid;
}

KrylovSolver::~KrylovSolver() = default;

void KrylovSolver::forget() { petsc_ = std::make_unique<Petsc>(); }

SolveReport KrylovSolver::solve(LinearSystem& system, std::span<double> solution,
                                std::optional<double> tolerance_asked) {
  const double tolerance_wanted = tolerance_asked.value_or(settings_.tolerance);
  const SuspendFpTraps suspended;
  const Communicator& ranks = system.ranks();
  TAILWATER_ASSERT(solution.size() == system.size(), "the solution must have one entry per row");
  if (system.constant_is_free()) system.make_rhs_consistent();
  const std::span<double> rhs = system.rhs();
  const double rhs_norm = norm_of(ranks, rhs);
  if (!std::isfinite(rhs_norm)) {
    throw SolverError("the source of the pressure equation is not finite");
  }
  if (rhs_norm < vanishing_rhs) {
    std::fill(solution.begin(), solution.end(), 0.0);
    return {};
  }

  SolveReport report;
  std::vector<double> residual = residual_of(system, solution);
  report.residual = norm_of(ranks, residual) / rhs_norm;
  const auto begin_at_zero = [&] {
    std::fill(solution.begin(), solution.end(), 0.0);
    residual.assign(rhs.begin(), rhs.end());
    report.residual = 1.0;
  };
  if (report.residual > hopeless_guess) begin_at_zero();
  Implementation implementation = implementation_for(settings_, water_, system);
  // Also where the guess will do: then the next solve with this pattern, of other diagonals, has it as it is here.
  CellMultigrid* multigrid = nullptr;
  if (implementation == Implementation::orthomin) multigrid = &petsc_->multigrid_for(system, report.residual);
  if (report.residual <= tolerance_wanted) return report;

  if (implementation == Implementation::petsc) petsc_->take(system, settings_, water_);
  double tolerance = tolerance_wanted;
  const auto attempt_once = [&] {
    const double target = tolerance * rhs_norm;
    const int most_iterations = settings_.max_iterations - report.iterations;
    switch (implementation) {
      case Implementation::swept_bicgstab:
        return attempt_of(SweptBicgstab(system).solve(residual, target, most_iterations, solution), target);
      case Implementation::orthomin:
        return attempt_of(Orthomin(system, *multigrid).solve(residual, target, most_iterations, solution), target);
      case Implementation::petsc:
        break;
    }
    return petsc_->attempt(system, tolerance, solution);
  };
  while (report.residual > tolerance_wanted) {
    const double residual_before = report.residual;
    const Attempt attempt = attempt_once();
    report.iterations += attempt.iterations;
    if (attempt.residual && tolerance_wanted >= least_sure_tolerance) {
      report.residual = *attempt.residual / rhs_norm;
    } else {
      residual = residual_of(system, solution);
      report.residual = norm_of(ranks, residual) / rhs_norm;
    }
    if (attempt.reason > 0) {
      // PETSc measures the preconditioned residual. If that, or rounding, made it stop too early, it continues from
      // there.
      tolerance *= 0.5 * tolerance_wanted / report.residual;
    } else if (is_breakdown(attempt.reason) && report.restarts == 0) {
      ++report.restarts;
      if (implementation != Implementation::petsc) petsc_->take(system, settings_, water_);
      implementation = Implementation::petsc;
      petsc_->change_method();
      begin_at_zero();
    } else {
      throw SolverError(fmt::format(
          "the pressure solve did not converge: {} after {} iterations, relative residual {:.3e}, asked for {:.1e} "
          "({} unknowns). Residuals on the way: {:.2e}. Remedy: raise pressure_solver.max_iterations, or choose "
          "another pressure_solver.method or preconditioner",
          KSPConvergedReasons[attempt.reason], report.iterations, report.residual, tolerance_wanted,
          system.size_of_all(), fmt::join(shown_residuals(attempt.history, residual_before), ", ")));
    }
  }
  if (system.constant_is_free()) {
    const double mean =
        ranks.sum(std::accumulate(solution.begin(), solution.end(), 0.0)) / static_cast<double>(system.size_of_all());
    for (double& value : solution) value -= mean;
  }
  return report;
}

}  // namespace tailwater
