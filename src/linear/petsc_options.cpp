#include "linear/petsc_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "base/finding.h"
#include "base/fp_traps.h"
#include "linear/triangular_sweeps.h"

namespace tailwater {
namespace {

const CaseLabel options_key = CaseLabel("pressure_solver").with_key("petsc_options");

/// With PETSc's default absolute tolerance any residual below it would count as converged, however large relative to
/// the source.
constexpr double no_absolute_tolerance = 0.0;

constexpr int longest_history = 2000;

/// Iterations after which FGMRES restarts: it stores two vectors of each iteration. Only cold solves need PETSc's
/// default of 30; with 20 they take a few iterations more (docs/notebook/2026-11-24-speed.md).
constexpr int max_directions = 20;

KSPType krylov_type(KrylovMethod method) {
  switch (method) {
    case KrylovMethod::gmres:
      return KSPGMRES;
    case KrylovMethod::fgmres:
      return KSPFGMRES;
    case KrylovMethod::bicgstab:
    case KrylovMethod::automatic:
      break;
  }
  return KSPBCGS;
}

PCType preconditioner_type(PreconditionerName name, const Communicator& ranks) {
  switch (name) {
    case PreconditionerName::cell_multigrid:
      return PCSHELL;
    case PreconditionerName::ilu:
      return ranks.is_alone() ? PCILU : PCBJACOBI;  // one block per rank, each with ILU
    case PreconditionerName::boomeramg:
      return PCHYPRE;
    case PreconditionerName::gamg:
      return PCGAMG;
    case PreconditionerName::jacobi:
      return PCJACOBI;
    case PreconditionerName::ssor:
    case PreconditionerName::automatic:
      break;
  }
  return PCSOR;
}

/// By default BoomerAMG solves its coarsest level by elimination. With a free constant that level is singular, and the
/// result is noise of any size. Only PETSc's options database can change this; an option set by the user takes
/// precedence.
void relax_coarsest_level() {
  constexpr const char* option = "-pressure_pc_hypre_boomeramg_relax_type_coarse";
  PetscBool is_set = PETSC_FALSE;
  check_petsc(PetscOptionsHasName(nullptr, nullptr, option, &is_set));
  if (!is_set) check_petsc(PetscOptionsSetValue(nullptr, option, "symmetric-SOR/Jacobi"));
}

/// Sets up a solver for each kind of system, so that PETSc queries every option that a run can query.
void ask_for_all_options(const PressureSolverTable& settings) {
  PetscMatrix identity;
  check_petsc(MatCreateSeqAIJ(PETSC_COMM_SELF, 2, 2, 1, nullptr, identity.create()));
  constexpr PetscScalar one = 1.0;
  for (PetscInt i = 0; i < 2; ++i) check_petsc(MatSetValues(identity.get(), 1, &i, 1, &i, &one, INSERT_VALUES));
  check_petsc(MatAssemblyBegin(identity.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(identity.get(), MAT_FINAL_ASSEMBLY));
  for (const double rows_deep : {shallow, deep}) {
    PetscKrylovSolver solver;
    check_petsc(KSPCreate(PETSC_COMM_SELF, solver.create()));
    check_petsc(KSPSetOperators(solver.get(), identity.get(), identity.get()));
    configure(solver.get(), settings, {.rows_deep = rows_deep, .constant_is_free = false}, Communicator());
    check_petsc(KSPSetUp(solver.get()));
  }
}

/// The user's options that PETSc has not queried.
std::vector<std::string> unused_options(const PressureSolverTable& settings) {
  PetscInt count = 0;
  char** names = nullptr;
  char** values = nullptr;
  check_petsc(PetscOptionsLeftGet(nullptr, &count, &names, &values));
  std::vector<std::string> unused;
  for (PetscInt k = 0; k < count; ++k) {
    if (settings.petsc_options.find(names[k]) != std::string::npos) unused.push_back(fmt::format("-{}", names[k]));
  }
  check_petsc(PetscOptionsLeftRestore(nullptr, &count, &names, &values));
  return unused;
}

/// Options of PETSc may open any file or run a program. Such options have one of these words in their names, or give
/// the file behind a colon. PETSc reads upper case as lower case.
constexpr std::array harmful{"view",          "monitor", "print", "file",   "draw",  "plot",
                             "save",          "load",    "dump",  "python", "shell", "converged_reason",
                             "converged_rate"};

/// Options that set the criterion by which a solve ends. With an absolute tolerance or a test of their own, PETSc's
/// methods would report any residual as converged.
constexpr std::array ends{"_ksp_rtol", "_ksp_atol", "_ksp_max_it", "_ksp_convergence_test", "_ksp_converged"};

/// The user's options, word by word, in lower case.
std::vector<std::string> words_of(std::string options) {
  std::ranges::transform(options, options.begin(), [](unsigned char letter) { return std::tolower(letter); });
  std::istringstream text(options);
  return {std::istream_iterator<std::string>(text), {}};
}

void require_harmless(const PressureSolverTable& settings) {
  const auto refuse = [&](const std::string& word, const char* remedy) {
    throw CaseError("petsc-option-not-allowed",
                    {"{} = \"{}\": {} is not allowed", options_key, settings.petsc_options, word}, {"{}", remedy});
  };
  for (const std::string& word : words_of(settings.petsc_options)) {
    const auto has = [&](const char* part) { return word.find(part) != word.npos; };
    const bool is_option = word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
    const bool is_ours = !is_option || word.starts_with("-pressure_");
    if (!is_ours || std::ranges::any_of(harmful, has) || word.find_first_of(":/") != word.npos) {
      refuse(word,
             "give options of PETSc's KSP and PC with the prefix pressure_, as in \"-pressure_ksp_type fgmres\", and "
             "none that print or open files");
    }
    if (std::ranges::any_of(ends, has)) {
      refuse(word, "set pressure_solver.tolerance or pressure_solver.max_iterations, which end a solve, instead");
    }
  }
}

}  // namespace

void configure(KSP solver, const PressureSolverTable& settings, const SystemTraits& system, const Communicator& ranks) {
  const SolverChoice choice = choose_solver(settings, system);
  check_petsc(KSPSetOptionsPrefix(solver, "pressure_"));
  check_petsc(KSPSetType(solver, krylov_type(choice.method)));
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner));
  check_petsc(PCSetType(preconditioner, preconditioner_type(choice.preconditioner, ranks)));
  check_petsc(PCSORSetOmega(preconditioner, ssor_factor));
  check_petsc(PCSORSetSymmetric(preconditioner, SOR_LOCAL_SYMMETRIC_SWEEP));
  // With right preconditioning PETSc does not remove the free constant from multigrid's result, and it grows without
  // bound.
  const bool is_singular_multigrid = system.constant_is_free && choice.preconditioner == PreconditionerName::boomeramg;
  const bool can_be_left = choice.method != KrylovMethod::fgmres;
  check_petsc(KSPSetPCSide(solver, is_singular_multigrid && can_be_left ? PC_LEFT : PC_RIGHT));
  check_petsc(
      KSPSetTolerances(solver, settings.tolerance, no_absolute_tolerance, PETSC_DEFAULT, settings.max_iterations));
  if (choice.method == KrylovMethod::fgmres) check_petsc(KSPGMRESSetRestart(solver, max_directions));
  check_petsc(KSPSetInitialGuessNonzero(solver, PETSC_TRUE));
  check_petsc(KSPSetResidualHistory(solver, nullptr, longest_history, PETSC_TRUE));
  if (is_singular_multigrid) relax_coarsest_level();
  check_petsc(KSPSetFromOptions(solver));
}

void take_petsc_options(const PressureSolverTable& settings) {
  if (settings.petsc_options.empty()) return;
  require_harmless(settings);
  const SuspendFpTraps suspended;
  need_petsc();
  try {
    check_petsc(PetscOptionsInsertString(nullptr, settings.petsc_options.c_str()));
    ask_for_all_options(settings);
  } catch (const SolverError& error) {
    throw CaseError("petsc-options-not-readable",
                    {"{} = \"{}\": {}", options_key, settings.petsc_options, error.what()}, {"give other options"});
  }
  const std::vector<std::string> unused = unused_options(settings);
  if (unused.empty()) return;
  throw CaseError(
      "petsc-option-unknown",
      {"{} = \"{}\": PETSc's solver has no option {}", options_key, settings.petsc_options, fmt::join(unused, ", ")},
      {"give options of its KSP and PC with the prefix pressure_, as in \"-pressure_ksp_type fgmres\""});
}

}  // namespace tailwater
