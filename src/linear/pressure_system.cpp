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
constexpr std::int64_t multigrid_pays_from = 40000;

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

/// Numbers divided by one that happens to vanish, not slow progress.
bool is_breakdown(KSPConvergedReason reason) {
  return reason == KSP_DIVERGED_BREAKDOWN || reason == KSP_DIVERGED_BREAKDOWN_BICG || reason == KSP_DIVERGED_DTOL ||
         reason == KSP_DIVERGED_NANORINF;
}

KSPType krylov_type(KrylovMethod method, std::int64_t unknowns) {
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

PCType preconditioner_type(PreconditionerName name, std::int64_t unknowns, bool is_alone) {
  switch (name) {
    case PreconditionerName::ilu:
      return is_alone ? PCILU : PCBJACOBI;  // whose blocks, one per rank, get ILU
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

/// BoomerAMG eliminates on its coarsest level, which with a free constant is singular: noise of any size comes back.
/// Only the options' database can tell it otherwise; the user's own word stands.
void relax_coarsest_level() {
  constexpr const char* option = "-pressure_pc_hypre_boomeramg_relax_type_coarse";
  PetscBool is_set = PETSC_FALSE;
  check_petsc(PetscOptionsHasName(nullptr, nullptr, option, &is_set));
  if (!is_set) check_petsc(PetscOptionsSetValue(nullptr, option, "symmetric-SOR/Jacobi"));
}

/// Type, preconditioner and the user's own options; what a solver of `unknowns` rows gets.
void configure(KSP solver, const PressureSolverTable& settings, std::int64_t unknowns, bool is_alone,
               bool constant_is_free) {
  check_petsc(KSPSetOptionsPrefix(solver, "pressure_"));
  check_petsc(KSPSetType(solver, krylov_type(settings.method, unknowns)));
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner));
  PCType type = preconditioner_type(settings.preconditioner, unknowns, is_alone);
  // Eisenstat's form solves for another unknown, whose null space is not the constants: then plain SSOR.
  if (constant_is_free && type == std::string_view(PCEISENSTAT)) type = PCSOR;
  check_petsc(PCSetType(preconditioner, type));
  check_petsc(PCEisenstatSetOmega(preconditioner, ssor_factor));
  check_petsc(PCEisenstatSetNoDiagonalScaling(preconditioner, PETSC_TRUE));  // it is 1 already
  check_petsc(PCSORSetOmega(preconditioner, ssor_factor));
  check_petsc(PCSORSetSymmetric(preconditioner, SOR_LOCAL_SYMMETRIC_SWEEP));
  // From the right PETSc does not take the free constant out of what multigrid returns, and it grows without bound.
  const bool is_singular_multigrid = constant_is_free && type == std::string_view(PCHYPRE);
  const bool can_be_left = krylov_type(settings.method, unknowns) != std::string_view(KSPFGMRES);
  check_petsc(KSPSetPCSide(solver, is_singular_multigrid && can_be_left ? PC_LEFT : PC_RIGHT));
  check_petsc(
      KSPSetTolerances(solver, settings.tolerance, no_absolute_tolerance, PETSC_DEFAULT, settings.max_iterations));
  check_petsc(KSPSetInitialGuessNonzero(solver, PETSC_TRUE));
  check_petsc(KSPSetResidualHistory(solver, nullptr, longest_history, PETSC_TRUE));
  if (is_singular_multigrid) relax_coarsest_level();
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
  for (const std::int64_t unknowns : {std::int64_t{1}, multigrid_pays_from}) {
    PetscKrylovSolver solver;
    check_petsc(KSPCreate(PETSC_COMM_SELF, solver.create()));
    check_petsc(KSPSetOperators(solver.get(), identity.get(), identity.get()));
    configure(solver.get(), settings, unknowns, true, false);
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

/// y = D x, D the diagonal, which is 1.
PetscErrorCode times_diagonal(Mat, Vec x, Vec y) { return VecCopy(x, y); }

}  // namespace

struct PressureSystem::Petsc {
  PetscMatrix matrix;
  std::vector<int> column_of_others;  ///< PETSc's own, which it renumbers
  PetscVector rhs;
  PetscVector solution;
  PetscVector residual;
  PetscKrylovSolver solver;
  PetscNullSpace constants;
  std::optional<std::size_t> solver_size;  ///< rows of this rank; none: it is not the settings' method

  /// A vector of PETSc's that shares `values`.
  static void wrap(const Communicator& ranks, std::span<double> values, PetscVector& vector) {
    const auto rows = static_cast<PetscInt>(values.size());
    check_petsc(ranks.is_alone()
                    ? VecCreateSeqWithArray(PETSC_COMM_SELF, 1, rows, values.data(), vector.create())
                    : VecCreateMPIWithArray(ranks.handle(), 1, rows, PETSC_DETERMINE, values.data(), vector.create()));
  }

  /// Tells PETSc that the values in the arrays it shares were changed.
  void take_new_values() const {
    check_petsc(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
    check_petsc(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
  }

  /// SSOR of several ranks in Eisenstat's form asks for an operation that PETSc 3.18 lacks, and drops at each assembly.
  void provide_diagonal() const {
    Mat own = nullptr;
    check_petsc(MatMPIAIJGetSeqAIJ(matrix.get(), &own, nullptr, nullptr));
    check_petsc(MatSetOperation(own, MATOP_MULT_DIAGONAL_BLOCK, reinterpret_cast<void (*)()>(times_diagonal)));
  }
};

PressureSystem::PressureSystem(const PressureSolverTable& settings, Communicator ranks)
    : settings_(settings), ranks_(std::move(ranks)), petsc_(std::make_unique<Petsc>()) {
  if (!settings_.petsc_options.empty()) {
    const SuspendFpTraps suspended;
    check_petsc(PetscOptionsInsertString(nullptr, settings_.petsc_options.c_str()));
    require_known_options(settings_);
  }
}

PressureSystem::~PressureSystem() = default;

void PressureSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns) {
  set_pattern(row_begin, columns, ExchangePlan({}, row_begin.size() - 1, {{}}));
}

void PressureSystem::set_pattern(std::span<const std::size_t> row_begin, std::span<const std::int32_t> columns,
                                 const ExchangePlan& halo) {
  const std::size_t rows = row_begin.size() - 1;
  const auto count = static_cast<std::int64_t>(rows);
  const std::int64_t first = ranks_.sum_before(count);
  size_of_all_ = ranks_.sum(count);
  std::vector<std::int64_t> number(rows);  // of each unknown, over all ranks
  std::iota(number.begin(), number.end(), first);
  halo.exchange(number);

  pattern_is_new_ = true;
  pattern_begin_.assign(row_begin.begin(), row_begin.end());
  slot_.resize(columns.size());
  diagonal_slot_.resize(rows);
  rhs_.assign(rows, 0.0);
  scale_.assign(rows, 1.0);
  for (Block* block : {&own_, &others_}) {
    block->begin.assign(1, 0);
    block->column.clear();
  }

  /// An entry of a row: the unknown, and the place of its weight; -1 for the diagonal.
  struct Entry {
    std::int64_t number;
    std::ptrdiff_t k;
    bool operator<(const Entry& other) const { return number < other.number; }
  };
  std::vector<Entry> entries;
  std::vector<std::size_t> of_others;  // the entries in others_, whose slots follow those of own_
  for (std::size_t i = 0; i < rows; ++i) {
    const Entry diagonal{first + static_cast<std::int64_t>(i), -1};
    bool has_diagonal = false;
    entries.clear();
    for (std::size_t k = row_begin[i]; k < row_begin[i + 1]; ++k) {
      if (!has_diagonal && number[columns[k]] > diagonal.number) {
        entries.push_back(diagonal);
        has_diagonal = true;
      }
      entries.push_back({number[columns[k]], static_cast<std::ptrdiff_t>(k)});
    }
    if (!has_diagonal) entries.push_back(diagonal);
    // Most rows are in order: neighbours come in that of their indices.
    if (!std::is_sorted(entries.begin(), entries.end())) std::sort(entries.begin(), entries.end());
    for (const Entry& entry : entries) {
      const std::int64_t column = entry.number - first;
      const bool is_own = column >= 0 && column < count;
      Block& block = is_own ? own_ : others_;
      const int slot = static_cast<int>(block.column.size());
      block.column.push_back(static_cast<int>(is_own ? column : entry.number));
      if (entry.k < 0) {
        diagonal_slot_[i] = slot;
      } else {
        slot_[entry.k] = slot;
        if (!is_own) of_others.push_back(static_cast<std::size_t>(entry.k));
      }
    }
    for (Block* block : {&own_, &others_}) block->begin.push_back(static_cast<int>(block->column.size()));
  }
  for (const std::size_t k : of_others) slot_[k] += static_cast<int>(own_.column.size());
  value_.resize(own_.column.size() + others_.column.size());
}

/// Calls body with every slot of row i.
template <class Body>
void PressureSystem::for_each_slot(std::size_t i, Body&& body) const {
  for (int slot = own_.begin[i]; slot < own_.begin[i + 1]; ++slot) body(slot);
  const int first = static_cast<int>(own_.column.size());
  for (int slot = others_.begin[i]; slot < others_.begin[i + 1]; ++slot) body(first + slot);
}

PressureSystem::Row::Row(PressureSystem& system, std::size_t i)
    : system_(system), i_(i), slot_(system.slot_.data() + system.pattern_begin_[i]), value_(system.value_.data()) {}

void PressureSystem::Row::finish(double diagonal, double rhs) {
  TAILWATER_ASSERT(diagonal != 0.0, "a pressure row has no diagonal");
  const double scale = 1.0 / diagonal;
  system_.for_each_slot(i_, [&](int slot) { value_[slot] *= -scale; });
  value_[system_.diagonal_slot_[i_]] = 1.0;
  system_.rhs_[i_] = scale * rhs;
  system_.scale_[i_] = scale;
}

void PressureSystem::Row::finish_as_zero() {
  system_.for_each_slot(i_, [&](int slot) { value_[slot] = 0.0; });
  finish(1.0, 0.0);
  system_.scale_[i_] = 0.0;
}

void PressureSystem::divide_diagonal(std::size_t i, double share) {
  const int diagonal = diagonal_slot_[i];
  for_each_slot(i, [&](int slot) {
    if (slot != diagonal) value_[slot] *= share;  // the diagonal is scaled to 1
  });
  rhs_[i] *= share;
  scale_[i] *= share;
}

void PressureSystem::make_rhs_consistent() {
  // The unscaled operator is symmetric, so its right-hand side must sum to zero.
  double sum = 0.0;
  for (std::size_t i = 0; i < rhs_.size(); ++i) {
    if (scale_[i] != 0.0) sum += rhs_[i] / scale_[i];
  }
  const double mean = ranks_.sum(sum) / static_cast<double>(size_of_all_);
  for (std::size_t i = 0; i < rhs_.size(); ++i) rhs_[i] -= mean * scale_[i];
}

void PressureSystem::sweep(std::span<double> solution) const {
  TAILWATER_ASSERT(solution.size() == size(), "the solution must have one entry per row");
  std::fill(solution.begin(), solution.end(), 0.0);
  const auto relax_row = [&](std::size_t i) {
    double sum = rhs_[i] + solution[i];  // the diagonal is 1
    for (int slot = own_.begin[i]; slot < own_.begin[i + 1]; ++slot) {
      sum -= value_[slot] * solution[own_.column[slot]];
    }
    solution[i] = sum;
  };
  for (std::size_t i = 0; i < size(); ++i) relax_row(i);
  for (std::size_t i = size(); i-- > 0;) relax_row(i);
}

void PressureSystem::make_matrix() {
  Petsc& petsc = *petsc_;
  const auto rows = static_cast<PetscInt>(size());
  if (ranks_.is_alone()) {
    check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, rows, rows, own_.begin.data(), own_.column.data(),
                                          value_.data(), petsc.matrix.create()));
  } else {
    petsc.column_of_others = others_.column;
    check_petsc(MatCreateMPIAIJWithSplitArrays(ranks_.handle(), rows, rows, PETSC_DETERMINE, PETSC_DETERMINE,
                                               own_.begin.data(), own_.column.data(), value_.data(),
                                               others_.begin.data(), petsc.column_of_others.data(),
                                               value_.data() + own_.column.size(), petsc.matrix.create()));
  }
  check_petsc(MatSetOption(petsc.matrix.get(), MAT_NEW_NONZERO_LOCATIONS, PETSC_FALSE));
  check_petsc(MatCreateVecs(petsc.matrix.get(), nullptr, petsc.residual.create()));
  if (constant_is_free_) {
    check_petsc(MatNullSpaceCreate(ranks_.handle(), PETSC_TRUE, 0, nullptr, petsc.constants.create()));
    check_petsc(MatSetNullSpace(petsc.matrix.get(), petsc.constants.get()));
  }
}

void PressureSystem::set_up_solver() {
  Petsc& petsc = *petsc_;
  if (ranks_.any(petsc.solver_size != size())) {
    check_petsc(KSPCreate(ranks_.handle(), petsc.solver.create()));
    petsc.solver_size = size();
    configure(petsc.solver.get(), settings_, size_of_all_, ranks_.is_alone(), constant_is_free_);
  }
  check_petsc(KSPSetOperators(petsc.solver.get(), petsc.matrix.get(), petsc.matrix.get()));
}

/// From 0 with GMRES; the next solve has the method of the settings again.
void PressureSystem::begin_again() {
  Petsc& petsc = *petsc_;
  check_petsc(VecZeroEntries(petsc.solution.get()));
  check_petsc(KSPSetType(petsc.solver.get(), KSPGMRES));
  petsc.solver_size.reset();
}

double PressureSystem::residual_norm() {
  Petsc& petsc = *petsc_;
  PetscReal norm = 0.0;
  check_petsc(MatMult(petsc.matrix.get(), petsc.solution.get(), petsc.residual.get()));
  check_petsc(VecAYPX(petsc.residual.get(), -1.0, petsc.rhs.get()));
  check_petsc(VecNorm(petsc.residual.get(), NORM_2, &norm));
  return norm;
}

SolveReport PressureSystem::solve(std::span<double> solution, std::optional<double> tolerance_asked) {
  const double tolerance_wanted = tolerance_asked.value_or(settings_.tolerance);
  const SuspendFpTraps suspended;
  TAILWATER_ASSERT(solution.size() == size(), "the solution must have one entry per row");
  if (constant_is_free_) make_rhs_consistent();
  const double rhs_norm = std::sqrt(ranks_.sum(std::inner_product(rhs_.begin(), rhs_.end(), rhs_.begin(), 0.0)));
  if (!std::isfinite(rhs_norm)) {
    throw SolverError("the source of the pressure equation is not finite");
  }
  if (rhs_norm < vanishing_rhs) {
    std::fill(solution.begin(), solution.end(), 0.0);
    return {};
  }

  Petsc& petsc = *petsc_;
  const bool is_first_of_pattern = pattern_is_new_;
  if (pattern_is_new_) {
    make_matrix();
    pattern_is_new_ = false;
  } else {
    petsc.take_new_values();
  }
  if (!ranks_.is_alone()) petsc.provide_diagonal();
  Petsc::wrap(ranks_, rhs_, petsc.rhs);
  Petsc::wrap(ranks_, solution, petsc.solution);

  SolveReport report;
  report.residual = residual_norm() / rhs_norm;
  if (report.residual > hopeless_guess) {
    check_petsc(VecZeroEntries(petsc.solution.get()));
    report.residual = 1.0;
  }
  if (report.residual <= tolerance_wanted) return report;

  set_up_solver();
  KSP solver = petsc.solver.get();
  // Later solves with one pattern are of rows little changed: the set-up of multigrid costs as much as a solve.
  check_petsc(KSPSetReusePreconditioner(solver, is_first_of_pattern ? PETSC_FALSE : PETSC_TRUE));
  double tolerance = tolerance_wanted;
  while (report.residual > tolerance_wanted) {
    const double residual_before = report.residual;
    check_petsc(KSPSetTolerances(solver, tolerance, no_absolute_tolerance, PETSC_DEFAULT, PETSC_DEFAULT));
    check_petsc(KSPSolve(solver, petsc.rhs.get(), petsc.solution.get()));
    PetscInt iterations = 0;
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    check_petsc(KSPGetIterationNumber(solver, &iterations));
    check_petsc(KSPGetConvergedReason(solver, &reason));
    report.iterations += static_cast<int>(iterations);
    report.residual = residual_norm() / rhs_norm;
    if (reason > 0) {
      // The solver measures the preconditioned residual; where that ends too early it goes on from there.
      tolerance *= 0.5 * tolerance_wanted / report.residual;
      continue;
    }
    if (is_breakdown(reason) && report.restarts == 0) {
      begin_again();
      ++report.restarts;
      report.residual = 1.0;
      continue;
    }
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
        KSPConvergedReasons[reason], report.iterations, report.residual, tolerance_wanted, size_of_all_,
        fmt::join(shown, ", ")));
  }
  if (constant_is_free_) {
    const double mean =
        ranks_.sum(std::accumulate(solution.begin(), solution.end(), 0.0)) / static_cast<double>(size_of_all_);
    for (double& value : solution) value -= mean;
  }
  return report;
}

}  // namespace tailwater
