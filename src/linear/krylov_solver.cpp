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
#include "linear/petsc_rows.h"
#include "linear/petsc_solver.h"
#include "linear/triangular_sweeps.h"

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

/// What PETSc's shell of a matrix calls. An exception in one of these functions has no way out through PETSc and ends
/// the program.
struct Operations {
  const LinearSystem* system;
  TriangularSweeps sweeps;

  static Operations& of(Mat shell) {
    Operations* operations = nullptr;
    check_petsc(MatShellGetContext(shell, &operations));
    return *operations;
  }

  /// y = A x
  static PetscErrorCode multiply(Mat shell, Vec x, Vec y) noexcept {
    const VectorAccess vectors(x, y);
    of(shell).system->multiply(vectors.from(), vectors.to());
    return 0;
  }

  static PetscErrorCode get_diagonal(Mat, Vec diagonal) noexcept { return VecSet(diagonal, 1.0); }

  /// What SSOR in Eisenstat's form asks for.
  static PetscErrorCode sweep(Mat shell, Vec b, PetscReal omega, MatSORType kind, PetscReal shift, PetscInt iterations,
                              PetscInt local_iterations, Vec x) noexcept {
    constexpr int from_zero = SOR_ZERO_INITIAL_GUESS;
    if (shift != 0.0 || iterations * local_iterations != 1) return PETSC_ERR_SUP;
    const VectorAccess vectors(b, x);
    TriangularSweeps& sweeps = of(shell).sweeps;
    if (kind == SOR_EISENSTAT) {
      sweeps.eisenstat(omega, vectors.from(), vectors.to());
    } else if (kind == (from_zero | SOR_LOCAL_FORWARD_SWEEP)) {
      sweeps.forward(omega, vectors.from(), vectors.to());
    } else if (kind == (from_zero | SOR_LOCAL_BACKWARD_SWEEP)) {
      sweeps.backward(omega, vectors.from(), vectors.to());
    } else if (kind == SOR_APPLY_UPPER) {
      sweeps.times_upper(omega, vectors.from(), vectors.to());
    } else {
      return PETSC_ERR_SUP;
    }
    return 0;
  }
};

/// correction = multigrid(residual), for PETSc. An exception here has no way out through PETSc and ends the program.
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

/// About twelve residuals of the history, scaled so that the first is `first`.
std::vector<double> shown_residuals(KSP solver, double first) {
  const PetscReal* history = nullptr;
  PetscInt length = 0;
  check_petsc(KSPGetResidualHistory(solver, &history, &length));
  std::vector<double> shown;
  const PetscInt stride = std::max<PetscInt>(1, length / 12);
  for (PetscInt k = 0; k < length; k += stride) shown.push_back(first * history[k] / history[0]);
  return shown;
}

}  // namespace

/// PETSc's objects, and the system they belong to.
struct KrylovSolver::Petsc {
  PetscMatrix matrix;  ///< a shell around the system
  std::optional<Operations> operations;
  PetscRows rows;  ///< only for preconditioners that need them
  PetscVector rhs;
  PetscVector solution;
  PetscVector residual;
  PetscKrylovSolver solver;
  PetscNullSpace constants;
  std::optional<CellMultigrid> multigrid;
  std::uint64_t pattern_number = 0;        ///< of the matrix
  std::optional<std::size_t> solver_size;  ///< rows of this rank; none after a restart with another method

  /// Returns whether the pattern is new.
  bool take_matrix(const LinearSystem& system) {
    if (pattern_number == system.pattern_number()) return false;
    pattern_number = system.pattern_number();
    operations.emplace(Operations{&system, TriangularSweeps(system)});
    const auto size = static_cast<PetscInt>(system.size());
    check_petsc(MatCreateShell(system.ranks().handle(), size, size, PETSC_DETERMINE, PETSC_DETERMINE, &*operations,
                               matrix.create()));
    using Function = void (*)();
    check_petsc(MatShellSetOperation(matrix.get(), MATOP_MULT, reinterpret_cast<Function>(Operations::multiply)));
    check_petsc(
        MatShellSetOperation(matrix.get(), MATOP_GET_DIAGONAL, reinterpret_cast<Function>(Operations::get_diagonal)));
    check_petsc(MatShellSetOperation(matrix.get(), MATOP_SOR, reinterpret_cast<Function>(Operations::sweep)));
    check_petsc(MatCreateVecs(matrix.get(), nullptr, residual.create()));
    if (system.constant_is_free()) {
      check_petsc(MatNullSpaceCreate(system.ranks().handle(), PETSC_TRUE, 0, nullptr, constants.create()));
      check_petsc(MatSetNullSpace(matrix.get(), constants.get()));
    }
    return true;
  }

  /// A solver is made anew for a new pattern: multigrid would carry bounds of the spectrum over from the old one, and a
  /// run that goes on from a checkpoint has no old one.
  void take_solver(LinearSystem& system, const PressureSolverTable& settings, double rows_deep, bool pattern_is_new) {
    const Communicator& ranks = system.ranks();
    if (ranks.any(pattern_is_new || solver_size != system.size())) {
      check_petsc(KSPCreate(ranks.handle(), solver.create()));
      solver_size = system.size();
      const SystemTraits traits{
          .rows_deep = rows_deep, .constant_is_free = system.constant_is_free(), .has_cells = system.has_cells()};
      configure(solver.get(), settings, traits, ranks.is_alone());
      take_multigrid(system);
    }
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
    check_petsc(PetscObjectTypeCompareAny(reinterpret_cast<PetscObject>(preconditioner), &is_one, PCEISENSTAT, PCSHELL,
                                          PCNONE, ""));
    return is_one;
  }

  /// Sets up our own multigrid if the solver has it.
  void take_multigrid(LinearSystem& system) {
    PC preconditioner = nullptr;
    PetscBool is_ours = PETSC_FALSE;
    check_petsc(KSPGetPC(solver.get(), &preconditioner));
    check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCSHELL, &is_ours));
    if (!is_ours || !system.has_cells()) return;
    multigrid.emplace(system);
    check_petsc(PCShellSetContext(preconditioner, &*multigrid));
    check_petsc(PCShellSetApply(preconditioner, apply_multigrid));
  }

  /// Restarts from 0 with GMRES. The next solve uses the method of the settings again.
  void begin_again() {
    check_petsc(VecZeroEntries(solution.get()));
    check_petsc(KSPSetType(solver.get(), KSPGMRES));
    solver_size.reset();
  }

  double residual_norm() const {
    PetscReal norm = 0.0;
    check_petsc(MatMult(matrix.get(), solution.get(), residual.get()));
    check_petsc(VecAYPX(residual.get(), -1.0, rhs.get()));
    check_petsc(VecNorm(residual.get(), NORM_2, &norm));
    return norm;
  }
};

KrylovSolver::KrylovSolver(const PressureSolverTable& settings, double rows_deep)
    : settings_(settings), rows_deep_(rows_deep), petsc_(std::make_unique<Petsc>()) {
  take_petsc_options(settings_);
}

bool KrylovSolver::needs_cells() const {
  const SolverChoice choice = choose_solver(settings_, {.rows_deep = rows_deep_, .has_cells = true});
  return choice.preconditioner == PreconditionerName::cell_multigrid;
}

KrylovSolver::~KrylovSolver() = default;

SolveReport KrylovSolver::solve(LinearSystem& system, std::span<double> solution,
                                std::optional<double> tolerance_asked) {
  const double tolerance_wanted = tolerance_asked.value_or(settings_.tolerance);
  const SuspendFpTraps suspended;
  const Communicator& ranks = system.ranks();
  TAILWATER_ASSERT(solution.size() == system.size(), "the solution must have one entry per row");
  if (system.constant_is_free()) system.make_rhs_consistent();
  const std::span<double> rhs = system.rhs();
  const double rhs_norm = std::sqrt(ranks.sum(std::inner_product(rhs.begin(), rhs.end(), rhs.begin(), 0.0)));
  if (!std::isfinite(rhs_norm)) {
    throw SolverError("the source of the pressure equation is not finite");
  }
  if (rhs_norm < vanishing_rhs) {
    std::fill(solution.begin(), solution.end(), 0.0);
    return {};
  }

  Petsc& petsc = *petsc_;
  const bool pattern_is_new = petsc.take_matrix(system);
  wrap(ranks, rhs, petsc.rhs);
  wrap(ranks, solution, petsc.solution);

  SolveReport report;
  report.residual = petsc.residual_norm() / rhs_norm;
  if (report.residual > hopeless_guess) {
    check_petsc(VecZeroEntries(petsc.solution.get()));
    report.residual = 1.0;
  }
  if (report.residual <= tolerance_wanted) return report;

  petsc.take_solver(system, settings_, rows_deep_, pattern_is_new);
  KSP solver = petsc.solver.get();
  // While the pattern is the same the rows change little, and setting up multigrid costs as much as a solve.
  check_petsc(KSPSetReusePreconditioner(solver, pattern_is_new ? PETSC_FALSE : PETSC_TRUE));
  double tolerance = tolerance_wanted;
  while (report.residual > tolerance_wanted) {
    const double residual_before = report.residual;
    check_petsc(KSPSetTolerances(solver, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
    check_petsc(KSPSolve(solver, petsc.rhs.get(), petsc.solution.get()));
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    check_petsc(KSPGetIterationNumber(solver, &iterations));
    check_petsc(KSPGetConvergedReason(solver, &reason));
    report.iterations += static_cast<int>(iterations);
    report.residual = petsc.residual_norm() / rhs_norm;
    if (reason > 0) {
      // The solver measures the preconditioned residual. If that made it stop too early, it continues from there.
      tolerance *= 0.5 * tolerance_wanted / report.residual;
      continue;
    }
    if (is_breakdown(reason) && report.restarts == 0) {
      petsc.begin_again();
      ++report.restarts;
      report.residual = 1.0;
      continue;
    }
    throw SolverError(fmt::format(
        "the pressure solve did not converge: {} after {} iterations, relative residual {:.3e}, asked for {:.1e} "
        "({} unknowns). Residuals on the way: {:.2e}. Remedy: raise pressure_solver.max_iterations, or choose "
        "another pressure_solver.method or preconditioner",
        KSPConvergedReasons[reason], report.iterations, report.residual, tolerance_wanted, system.size_of_all(),
        fmt::join(shown_residuals(solver, residual_before), ", ")));
  }
  if (system.constant_is_free()) {
    const double mean =
        ranks.sum(std::accumulate(solution.begin(), solution.end(), 0.0)) / static_cast<double>(system.size_of_all());
    for (double& value : solution) value -= mean;
  }
  return report;
}

}  // namespace tailwater
