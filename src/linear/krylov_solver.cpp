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
#include "linear/petsc_solver.h"
#include "linear/triangular_sweeps.h"

namespace tailwater {
namespace {

/// Below this norm of the right-hand side the answer is zero pressure: nothing drives it, and squares soon underflow.
constexpr double vanishing_rhs = 1e-100;

/// PETSc gives up on a guess whose residual is 1e5 times the source. Below that a guess helps even if its residual is
/// larger than that of 0: its error is rough, and rough errors are smoothed away first.
constexpr double hopeless_guess = 1e4;

static_assert(sizeof(PetscInt) == sizeof(int), "the CSR arrays are shared with PETSc");
static_assert(sizeof(PetscScalar) == sizeof(double), "the values are shared with PETSc");

/// Whether the method divided by a number that happened to vanish. Slow convergence is no breakdown.
bool is_breakdown(KSPConvergedReason reason) {
  return reason == KSP_DIVERGED_BREAKDOWN || reason == KSP_DIVERGED_BREAKDOWN_BICG || reason == KSP_DIVERGED_DTOL ||
         reason == KSP_DIVERGED_NANORINF;
}

/// y = D x, where the diagonal D is 1.
PetscErrorCode times_diagonal(Mat, Vec x, Vec y) { return VecCopy(x, y); }

/// The operation with which PETSc sweeps over the rows of one rank.
using SweepOperation = PetscErrorCode (*)(Mat, Vec, PetscReal, MatSORType, PetscReal, PetscInt, PetscInt, Vec);

/// The name under which the block of this rank has its FastSweeps.
constexpr const char* fast_sweeps_name = "tailwater_sweeps";

/// What takes the place of PETSc's sweeps over the rows of this rank.
struct FastSweeps {
  LinearSystem* system = nullptr;
  TriangularSweeps sweeps;
  bool has_values = false;  ///< whether `sweeps` have the values of the present matrix
  SweepOperation of_petsc = nullptr;
};

/// The sweeps of SSOR in Eisenstat's form by TriangularSweeps, and all others by PETSc itself.
PetscErrorCode sweep(Mat matrix, Vec b, PetscReal omega, MatSORType kind, PetscReal shift, PetscInt iterations,
                     PetscInt local_iterations, Vec x) noexcept {
  PetscObject holder = nullptr;
  void* pointer = nullptr;
  check_petsc(PetscObjectQuery(reinterpret_cast<PetscObject>(matrix), fast_sweeps_name, &holder));
  check_petsc(PetscContainerGetPointer(reinterpret_cast<PetscContainer>(holder), &pointer));
  FastSweeps& fast = *static_cast<FastSweeps*>(pointer);
  constexpr int from_zero = SOR_ZERO_INITIAL_GUESS;
  const bool is_eisenstat = kind == SOR_EISENSTAT;
  const bool is_forward = kind == (from_zero | SOR_LOCAL_FORWARD_SWEEP);
  const bool is_backward = kind == (from_zero | SOR_LOCAL_BACKWARD_SWEEP);
  if (shift != 0.0 || iterations * local_iterations != 1 || !(is_eisenstat || is_forward || is_backward)) {
    return fast.of_petsc(matrix, b, omega, kind, shift, iterations, local_iterations, x);
  }
  if (!fast.has_values) {
    const LinearSystem::Block& own = fast.system->own();
    fast.sweeps.take(own.begin, own.column, fast.system->diagonal_of_own(), fast.system->values_of_own());
    fast.has_values = true;
  }
  const PetscScalar* from = nullptr;
  PetscScalar* to = nullptr;
  check_petsc(VecGetArrayRead(b, &from));
  check_petsc(VecGetArrayWrite(x, &to));
  const std::span<const double> b_rows(from, fast.system->size());
  const std::span<double> x_rows(to, fast.system->size());
  if (is_eisenstat) {
    fast.sweeps.eisenstat(omega, b_rows, x_rows);
  } else if (is_forward) {
    fast.sweeps.forward(omega, b_rows, x_rows);
  } else {
    fast.sweeps.backward(omega, b_rows, x_rows);
  }
  check_petsc(VecRestoreArrayWrite(x, &to));
  check_petsc(VecRestoreArrayRead(b, &from));
  return 0;
}

/// correction = multigrid(residual), for PETSc. An exception here has no way out through PETSc and ends the program.
PetscErrorCode apply_multigrid(PC preconditioner, Vec residual, Vec correction) noexcept {
  CellMultigrid* multigrid = nullptr;
  check_petsc(PCShellGetContext(preconditioner, &multigrid));
  PetscInt size = 0;
  const PetscScalar* from = nullptr;
  PetscScalar* to = nullptr;
  check_petsc(VecGetLocalSize(residual, &size));
  check_petsc(VecGetArrayRead(residual, &from));
  check_petsc(VecGetArrayWrite(correction, &to));
  const auto count = static_cast<std::size_t>(size);
  multigrid->apply({from, count}, {to, count});
  check_petsc(VecRestoreArrayWrite(correction, &to));
  check_petsc(VecRestoreArrayRead(residual, &from));
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
  PetscMatrix matrix;
  std::vector<int> column_of_others;  ///< a copy for PETSc, which renumbers it
  PetscVector rhs;
  PetscVector solution;
  PetscVector residual;
  PetscKrylovSolver solver;
  PetscNullSpace constants;
  std::optional<CellMultigrid> multigrid;
  FastSweeps fast_sweeps;
  std::uint64_t pattern_number = 0;        ///< of the matrix
  std::optional<std::size_t> solver_size;  ///< rows of this rank; none after a restart with another method

  /// Returns whether the pattern is new.
  bool take_matrix(LinearSystem& system) {
    const bool is_new = pattern_number != system.pattern_number();
    if (is_new) {
      make_matrix(system);
      pattern_number = system.pattern_number();
    }
    // The values in the shared arrays have changed, and PETSc chooses the matrix's operations at an assembly.
    check_petsc(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
    check_petsc(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
    provide_sweeps(system);
    return is_new;
  }

  void make_matrix(LinearSystem& system) {
    const auto rows = static_cast<PetscInt>(system.size());
    const LinearSystem::Block& own = system.own();
    const LinearSystem::Block& others = system.others();
    if (system.ranks().is_alone()) {
      check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, rows, rows, const_cast<int*>(own.begin.data()),
                                            const_cast<int*>(own.column.data()), system.values_of_own().data(),
                                            matrix.create()));
    } else {
      column_of_others = others.column;
      check_petsc(MatCreateMPIAIJWithSplitArrays(
          system.ranks().handle(), rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, const_cast<int*>(own.begin.data()),
          const_cast<int*>(own.column.data()), system.values_of_own().data(), const_cast<int*>(others.begin.data()),
          column_of_others.data(), system.values_of_others().data(), matrix.create()));
    }
    check_petsc(MatSetOption(matrix.get(), MAT_NEW_NONZERO_LOCATIONS, PETSC_FALSE));
    // Where many rows have equal columns, as in separate drops, PETSc treats them in blocks. SSOR in Eisenstat's form
    // then reads a block diagonal that was never built (PETSc 3.18).
    check_petsc(MatSetOption(matrix.get(), MAT_USE_INODES, PETSC_FALSE));
    check_petsc(MatCreateVecs(matrix.get(), nullptr, residual.create()));
    if (system.constant_is_free()) {
      check_petsc(MatNullSpaceCreate(system.ranks().handle(), PETSC_TRUE, 0, nullptr, constants.create()));
      check_petsc(MatSetNullSpace(matrix.get(), constants.get()));
    }
  }

  /// Makes PETSc use our sweeps over the rows of this rank; it drops them at each assembly. On several ranks, SSOR in
  /// Eisenstat's form also needs an operation that PETSc 3.18 lacks.
  void provide_sweeps(LinearSystem& system) {
    Mat own = matrix.get();
    if (!system.ranks().is_alone()) {
      check_petsc(MatMPIAIJGetSeqAIJ(matrix.get(), &own, nullptr, nullptr));
      check_petsc(MatSetOperation(own, MATOP_MULT_DIAGONAL_BLOCK, reinterpret_cast<void (*)()>(times_diagonal)));
    }
    void (*present)() = nullptr;
    check_petsc(MatGetOperation(own, MATOP_SOR, &present));
    if (present != reinterpret_cast<void (*)()>(sweep)) {
      fast_sweeps.of_petsc = reinterpret_cast<SweepOperation>(present);
    }
    fast_sweeps.system = &system;
    fast_sweeps.has_values = false;
    PetscContainer holder = nullptr;
    check_petsc(PetscContainerCreate(PETSC_COMM_SELF, &holder));
    check_petsc(PetscContainerSetPointer(holder, &fast_sweeps));
    check_petsc(PetscObjectCompose(reinterpret_cast<PetscObject>(own), fast_sweeps_name,
                                   reinterpret_cast<PetscObject>(holder)));
    check_petsc(PetscContainerDestroy(&holder));  // the matrix keeps it
    check_petsc(MatSetOperation(own, MATOP_SOR, reinterpret_cast<void (*)()>(sweep)));
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
    check_petsc(KSPSetOperators(solver.get(), matrix.get(), matrix.get()));
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
