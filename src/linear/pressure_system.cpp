#include "linear/pressure_system.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/assert.h"
#include "base/error.h"
#include "base/fp_traps.h"
#include "linear/petsc.h"

namespace tailwater {
namespace {

/// Below this many unknowns SSOR with BiCGStab costs less than algebraic multigrid with its set-up
/// (docs/theory/linear.md gives the measurement).
constexpr std::size_t multigrid_pays_from = 40000;

/// Norm of the right-hand side below which the answer is zero pressure: nothing drives it, and squares underflow soon.
constexpr double vanishing_rhs = 1e-100;

/// PETSc's own absolute tolerance would call any residual below it converged, however large relative to the source.
constexpr double no_absolute_tolerance = 0.0;

/// PETSc gives up on a guess whose residual is 1e5 of the source. Below that a guess helps even where its residual is
/// larger than that of 0: what is left is rough, and smoothed away first.
constexpr double hopeless_guess = 1e4;

constexpr int longest_history = 2000;

/// Relaxation factor of SSOR; iterations depend on it weakly between 1.2 and 1.5 (docs/theory/linear.md).
constexpr double ssor_factor = 1.35;

static_assert(sizeof(PetscInt) == sizeof(int), "the CSR arrays are shared with PETSc");
static_assert(sizeof(PetscScalar) == sizeof(double), "the values are shared with PETSc");

KSPType krylov_type(KrylovMethod method, std::size_t unknowns) {
  switch (method) {
    case KrylovMethod::bicgstab:
      return KSPBCGS;
    case KrylovMethod::gmres:
      return KSPGMRES;
    case KrylovMethod::fgmres:
      return KSPFGMRES;
    case KrylovMethod::automatic:
      break;
  }
  return unknowns < multigrid_pays_from ? KSPBCGS : KSPGMRES;
}

PCType preconditioner_type(PreconditionerName name, std::size_t unknowns) {
  switch (name) {
    case PreconditionerName::ilu:
      return PCILU;
    case PreconditionerName::boomeramg:
      return PCHYPRE;
    case PreconditionerName::gamg:
      return PCGAMG;
    case PreconditionerName::jacobi:
      return PCJACOBI;
    case PreconditionerName::ssor:
      return PCEISENSTAT;
    case PreconditionerName::automatic:
      break;
  }
  return unknowns < multigrid_pays_from ? PCEISENSTAT : PCHYPRE;
}

/// Type, preconditioner and the user's own options; what a solver of `unknowns` rows gets.
void configure(KSP solver, const PressureSolverTable& settings, std::size_t unknowns, bool constant_is_free) {
  check_petsc(KSPSetOptionsPrefix(solver, "pressure_"));
  check_petsc(KSPSetType(solver, krylov_type(settings.method, unknowns)));
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner));
  PCType type = preconditioner_type(settings.preconditioner, unknowns);
  // Eisenstat's form solves for another unknown, whose null space is not the constants: then plain SSOR.
  if (constant_is_free && type == std::string_view(PCEISENSTAT)) type = PCSOR;
  check_petsc(PCSetType(preconditioner, type));
  check_petsc(PCEisenstatSetOmega(preconditioner, ssor_factor));
  check_petsc(PCEisenstatSetNoDiagonalScaling(preconditioner, PETSC_TRUE));  // it is 1 already
  check_petsc(PCSORSetOmega(preconditioner, ssor_factor));
  check_petsc(PCSORSetSymmetric(preconditioner, SOR_LOCAL_SYMMETRIC_SWEEP));
  check_petsc(KSPSetPCSide(solver, PC_RIGHT));
  check_petsc(
      KSPSetTolerances(solver, settings.tolerance, no_absolute_tolerance, PETSC_DEFAULT, settings.max_iterations));
  check_petsc(KSPSetInitialGuessNonzero(solver, PETSC_TRUE));
  check_petsc(KSPSetResidualHistory(solver, nullptr, longest_history, PETSC_TRUE));
  check_petsc(KSPSetFromOptions(solver));
}

/// Throws InputError for options that neither a small nor a large solver asks for: PETSc itself ignores them in
/// silence.
void require_known_options(const PressureSolverTable& settings) {
  PetscMatrix identity;
  check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, 2, 2, 1, nullptr, identity.create()));
  for (PetscInt i = 0; i < 2; ++i) check_petsc(MatSetValue(identity.get(), i, i, 1.0, INSERT_VALUES));
  check_petsc(MatAssemblyBegin(identity.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(identity.get(), MAT_FINAL_ASSEMBLY));
  for (const std::size_t unknowns : {std::size_t{1}, multigrid_pays_from}) {
    PetscKrylovSolver solver;
    check_petsc(KSPCreate(PETSC_COMM_SELF, solver.create()));
    check_petsc(KSPSetOperators(solver.get(), identity.get(), identity.get()));
    configure(solver.get(), settings, unknowns, false);
    check_petsc(KSPSetUp(solver.get()));
  }
  PetscInt count = 0;
  char** names = nullptr;
  char** values = nullptr;
  check_petsc(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> unknown;
  for (PetscInt k = 0; k < count; ++k) {
    if (settings.petsc_options.find(names[k]) != std::string::npos) unknown.push_back(fmt::format("-{}", names[k]));
  }
  check_petsc(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  if (unknown.empty()) return;
  throw InputError(fmt::format(
      "pressure_solver.petsc_options = \"{}\": PETSc's solver asks for no option {}; give options of its KSP "
      "and PC with the prefix pressure_, as in \"-pressure_ksp_type fgmres\"",
      settings.petsc_options, fmt::join(unknown, ", ")));
}

}  // namespace

struct PressureSystem::Petsc {
  PetscMatrix matrix;
  PetscVector rhs;
  PetscVector solution;
  PetscKrylovSolver solver;
  PetscNullSpace constants;
  std::size_t solver_size = 0;
};

PressureSystem::PressureSystem(const PressureSolverTable& settings)
    : settings_(settings), petsc_(std::make_unique<Petsc>()) {
  if (!settings_.petsc_options.empty()) {
    const SuspendFpTraps suspended;
    check_petsc(PetscOptionsInsertString(nullptr, settings_.petsc_options.c_str()));
    require_known_options(settings_);
  }
}

PressureSystem::~PressureSystem() = default;

void PressureSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns) {
  const std::size_t rows = row_begin.size() - 1;
  const std::size_t entries = columns.size() + rows;
  pattern_is_new_ = true;
  pattern_begin_.assign(row_begin.begin(), row_begin.end());
  csr_begin_.resize(rows + 1);
  csr_column_.resize(entries);
  csr_value_.resize(entries);
  slot_.resize(columns.size());
  diagonal_slot_.resize(rows);
  rhs_.assign(rows, 0.0);
  scale_.assign(rows, 1.0);

  std::vector<std::size_t> by_column;
  csr_begin_[0] = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    const auto diagonal = static_cast<std::int32_t>(i);
    int slot = csr_begin_[i];
    diagonal_slot_[i] = -1;
    const auto take = [&](std::size_t k) {
      if (diagonal_slot_[i] < 0 && columns[k] > diagonal) diagonal_slot_[i] = slot++;
      csr_column_[slot] = columns[k];
      slot_[k] = slot++;
    };
    const auto row = columns.subspan(row_begin[i], row_begin[i + 1] - row_begin[i]);
    if (std::is_sorted(row.begin(), row.end())) {
      for (std::size_t k = row_begin[i]; k < row_begin[i + 1]; ++k) take(k);
    } else {
      by_column.resize(row.size());
      std::iota(by_column.begin(), by_column.end(), row_begin[i]);
      std::sort(by_column.begin(), by_column.end(),
                [&](std::size_t a, std::size_t b) { return columns[a] < columns[b]; });
      for (const std::size_t k : by_column) take(k);
    }
    if (diagonal_slot_[i] < 0) diagonal_slot_[i] = slot++;
    csr_column_[diagonal_slot_[i]] = diagonal;
    csr_begin_[i + 1] = slot;
  }
}

PressureSystem::Row::Row(PressureSystem& system, std::size_t i)
    : system_(system), i_(i), slot_(system.slot_.data() + system.pattern_begin_[i]), value_(system.csr_value_.data()) {}

void PressureSystem::Row::finish(double diagonal, double rhs) {
  TAILWATER_ASSERT(diagonal != 0.0, "a pressure row has no diagonal");
  const double scale = 1.0 / diagonal;
  for (int slot = system_.csr_begin_[i_]; slot < system_.csr_begin_[i_ + 1]; ++slot) value_[slot] *= -scale;
  value_[system_.diagonal_slot_[i_]] = 1.0;
  system_.rhs_[i_] = scale * rhs;
  system_.scale_[i_] = scale;
}

void PressureSystem::Row::finish_as_zero() {
  std::fill(value_ + system_.csr_begin_[i_], value_ + system_.csr_begin_[i_ + 1], 0.0);
  finish(1.0, 0.0);
  system_.scale_[i_] = 0.0;
}

void PressureSystem::divide_diagonal(std::size_t i, double share) {
  for (int slot = csr_begin_[i]; slot < csr_begin_[i + 1]; ++slot) {
    if (slot != diagonal_slot_[i]) csr_value_[slot] *= share;  // the diagonal is scaled to 1
  }
  rhs_[i] *= share;
  scale_[i] *= share;
}

void PressureSystem::make_rhs_consistent() {
  // The unscaled operator is symmetric, so its right-hand side must sum to zero.
  double sum = 0.0;
  for (std::size_t i = 0; i < rhs_.size(); ++i) {
    if (scale_[i] != 0.0) sum += rhs_[i] / scale_[i];
  }
  const double mean = sum / static_cast<double>(rhs_.size());
  for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] -= mean * scale_[i];
}

double PressureSystem::less_row(double value, std::size_t i, std::span<const double> solution) const {
  for (int slot = csr_begin_[i]; slot < csr_begin_[i + 1]; ++slot) {
    value -= csr_value_[slot] * solution[csr_column_[slot]];
  }
  return value;
}

double PressureSystem::residual_norm(std::span<const double> solution) const {
  double squares = 0.0;
  for (std::size_t i = 0; i < rhs_.size(); ++i) {
    const double residual = less_row(rhs_[i], i, solution);
    squares += residual * residual;
  }
  return std::sqrt(squares);
}

void PressureSystem::sweep(std::span<double> solution) const {
  TAILWATER_ASSERT(solution.size() == size(), "the solution must have one entry per row");
  std::fill(solution.begin(), solution.end(), 0.0);
  const auto relax_row = [&](std::size_t i) {
    solution[i] = less_row(rhs_[i] + solution[i], i, solution);  // the diagonal is 1
  };
  for (std::size_t i = 0; i < size(); ++i) relax_row(i);
  for (std::size_t i = size(); i-- > 0;) relax_row(i);
}

SolveReport PressureSystem::solve(std::span<double> solution, std::optional<double> tolerance_asked) {
  const double tolerance_wanted = tolerance_asked.value_or(settings_.tolerance);
  const SuspendFpTraps suspended;
  TAILWATER_ASSERT(solution.size() == size(), "the solution must have one entry per row");
  const auto rows = static_cast<PetscInt>(size());
  if (constant_is_free_) make_rhs_consistent();
  const double rhs_norm = std::sqrt(std::inner_product(rhs_.begin(), rhs_.end(), rhs_.begin(), 0.0));
  if (!std::isfinite(rhs_norm)) {
    throw SolverError("the source of the pressure equation is not finite");
  }
  if (rhs_norm < vanishing_rhs) {
    std::fill(solution.begin(), solution.end(), 0.0);
    return {};
  }

  SolveReport report;
  report.residual = residual_norm(solution) / rhs_norm;
  if (report.residual > hopeless_guess) {
    std::fill(solution.begin(), solution.end(), 0.0);
    report.residual = 1.0;
  }
  if (report.residual <= tolerance_wanted) return report;

  Petsc& petsc = *petsc_;
  const bool is_first_of_pattern = pattern_is_new_;
  if (pattern_is_new_) {
    check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, rows, rows, csr_begin_.data(), csr_column_.data(),
                                          csr_value_.data(), petsc.matrix.create()));
    check_petsc(MatSetOption(petsc.matrix.get(), MAT_NEW_NONZERO_LOCATIONS, PETSC_FALSE));
    if (constant_is_free_) {
      check_petsc(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_TRUE, 0, nullptr, petsc.constants.create()));
      check_petsc(MatSetNullSpace(petsc.matrix.get(), petsc.constants.get()));
    }
    pattern_is_new_ = false;
  }
  // The values were refreshed in the shared array; taking and returning it tells PETSc so.
  PetscScalar* values = nullptr;
  check_petsc(MatSeqAIJGetArray(petsc.matrix.get(), &values));
  check_petsc(MatSeqAIJRestoreArray(petsc.matrix.get(), &values));
  check_petsc(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, rows, rhs_.data(), petsc.rhs.create()));
  check_petsc(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, rows, solution.data(), petsc.solution.create()));

  if (petsc.solver_size != size()) {
    check_petsc(KSPCreate(PETSC_COMM_SELF, petsc.solver.create()));
    petsc.solver_size = size();
    configure(petsc.solver.get(), settings_, size(), constant_is_free_);
  }
  KSP solver = petsc.solver.get();
  check_petsc(KSPSetOperators(solver, petsc.matrix.get(), petsc.matrix.get()));
  // Later solves with one pattern are of rows little changed: the set-up of multigrid costs as much as a solve.
  check_petsc(KSPSetReusePreconditioner(solver, is_first_of_pattern ? PETSC_FALSE : PETSC_TRUE));
  // The solver measures the preconditioned residual; where that ends too early it goes on from there.
  for (double tolerance = tolerance_wanted; report.residual > tolerance_wanted;
       tolerance *= 0.5 * tolerance_wanted / report.residual) {
    const double residual_before = report.residual;
    check_petsc(KSPSetTolerances(solver, tolerance, no_absolute_tolerance, PETSC_DEFAULT, PETSC_DEFAULT));
    check_petsc(KSPSolve(solver, petsc.rhs.get(), petsc.solution.get()));
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    check_petsc(KSPGetIterationNumber(solver, &iterations));
    check_petsc(KSPGetConvergedReason(solver, &reason));
    report.iterations += static_cast<int>(iterations);
    report.residual = residual_norm(solution) / rhs_norm;
    if (reason > 0) continue;
    const PetscReal* history = nullptr;
    PetscInt length = 0;
    check_petsc(KSPGetResidualHistory(solver, &history, &length));
    std::vector<double> shown;
    const PetscInt stride = std::max<PetscInt>(1, length / 12);
    for (PetscInt k = 0; k < length; k += stride) shown.push_back(residual_before * history[k] / history[0]);
    throw SolverError(fmt::format(
        "the pressure solve did not converge: {} after {} iterations, relative residual {:.3e}, asked for {:.1e} "
        "({} unknowns). Residuals on the way: {:.2e}. Remedy: raise pressure_solver.max_iterations, or choose "
        "another pressure_solver.method or preconditioner",
        KSPConvergedReasons[reason], report.iterations, report.residual, tolerance_wanted, rows,
        fmt::join(shown, ", ")));
  }
  if (constant_is_free_) {
    const double mean = std::accumulate(solution.begin(), solution.end(), 0.0) / static_cast<double>(solution.size());
    for (double& value : solution) value -= mean;
  }
  return report;
}

}  // namespace tailwater
