#include "linear/linear_solver.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/assert.h"
#include "base/error.h"
#include "base/fp_traps.h"
#include "case/spec.h"
#include "linear/bicgstab.h"
#include "linear/dot.h"
#include "linear/kept_multigrid.h"
#include "linear/method.h"
#include "linear/orthomin.h"
#include "linear/petsc_method.h"
#include "linear/petsc_options.h"
#include "linear/solver_choice.h"

namespace tailwater {
namespace {

/// Below this norm of the right-hand side the solution is zero pressure: there is no source, and squares soon
/// underflow.
constexpr double vanishing_rhs = 1e-100;

/// PETSc gives up on a guess whose residual is 1e5 times the source. Below that a guess helps even if its residual is
/// larger than that of 0: its error is rough, and rough errors are smoothed away first.
constexpr double hopeless_guess = 1e4;

/// Below this tolerance the residual that a method updates may contain rounding errors, so the residual is computed
/// from x.
constexpr double min_sure_tolerance = 1e-7;

/// Maximum number of times that a method may report convergence. Each time its tolerance is halved, or reduced further.
/// A method that has not reached the goal after this number of attempts will not reach it.
constexpr int max_attempts = 30;

/// A system, its current solution, and its residual. Its functions are collective.
class Solve {
 public:
  Solve(const LinearSystem& system, std::span<double> x, double tolerance)
      : system_(system), iterate_{x, {}}, rhs_norm_(norm(system.rhs())), tolerance_(tolerance), asked_(tolerance) {
    if (!std::isfinite(rhs_norm_)) {
      throw SolverError(
          "the source of the pressure equation is not finite: a velocity or a force has overflowed; remedy: smaller "
          "numbers in the case where one is far too large, such as a roughness, a viscosity or a strength");
    }
  }

  bool has_source() const { return rhs_norm_ >= vanishing_rhs; }
  bool is_done() const { return report_.residual <= tolerance_; }
  const SolveReport& report() const { return report_; }
  double tolerance() const { return tolerance_; }

  void begin_at_zero() {
    std::ranges::fill(iterate_.x, 0.0);
    iterate_.residual.assign(system_.rhs().begin(), system_.rhs().end());
    report_.residual = 1.0;
  }

  void begin_at_guess() {
    find_residual();
    if (!(report_.residual <= hopeless_guess)) begin_at_zero();
  }

  void restart() {
    ++report_.restarts;
    begin_at_zero();
  }

  MethodOutcome improve(Method& method, int iterations) {
    MethodOutcome outcome = method.improve(system_, {asked_, asked_ * rhs_norm_, iterations}, iterate_);
    report_.iterations += outcome.iterations;
    const bool is_known = outcome.residual && tolerance_ >= min_sure_tolerance;
    if (is_known) {
      report_.residual = *outcome.residual / rhs_norm_;
    } else {
      find_residual();
    }
    return outcome;
  }

  /// Reduces the tolerance of the method's next attempt by the factor by which it missed the goal, and by half.
  void ask_for_more() { asked_ *= 0.5 * tolerance_ / report_.residual; }

 private:
  double norm(std::span<const double> x) const { return std::sqrt(system_.ranks().sum(dot(x, x))); }

  void find_residual() {
    std::vector<double> with_ghosts(iterate_.x.begin(), iterate_.x.end());
    std::vector<double>& residual = iterate_.residual;
    residual.resize(iterate_.x.size());
    system_.multiply(with_ghosts, residual);
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = system_.rhs()[i] - residual[i];
    report_.residual = norm(residual) / rhs_norm_;
  }

  const LinearSystem& system_;
  Iterate iterate_;
  double rhs_norm_;
  double tolerance_;  ///< goal of the solve
  double asked_;      ///< goal of the method
  SolveReport report_;
};

void take_out_mean(const LinearSystem& system, std::span<double> x) {
  const double sum = system.ranks().sum(std::accumulate(x.begin(), x.end(), 0.0));
  const double mean = sum / static_cast<double>(system.size_of_all());
  for (double& value : x) value -= mean;
}

/// About twelve residuals of the history, scaled so that the first is `first`.
std::vector<double> shown_residuals(const std::vector<double>& history, double first) {
  if (history.empty() || history[0] == 0.0) return {first};  // no residual is known
  std::vector<double> shown;
  const std::size_t stride = std::max<std::size_t>(1, history.size() / 12);
  for (std::size_t k = 0; k < history.size(); k += stride) shown.push_back(first * history[k] / history[0]);
  return shown;
}

/// `first` is the residual from which the method's history begins.
SolverError no_convergence(const LinearSystem& system, const Solve& solve, const MethodOutcome& outcome, double first) {
  return SolverError(
      "the pressure solve did not converge: {} after {} iterations, relative residual {:.3e}, asked for {:.1e} ({} "
      "unknowns). Residuals on the way: {:.2e}. Remedy: raise pressure_solver.max_iterations, or choose another "
      "pressure_solver.preconditioner or petsc_options",
      outcome.reason, solve.report().iterations, solve.report().residual, solve.tolerance(), system.size_of_all(),
      fmt::join(shown_residuals(outcome.history, first), ", "));
}

}  // namespace

/// The methods with the data that they keep for a pattern, and what chooses among them.
struct LinearSolver::Methods {
  Methods(const PressureSolverTable& of_case, const SystemTraits& of_all) : settings(of_case), water(of_all) {
    take_petsc_options(settings);
  }

  void forget() { kept = std::make_unique<Kept>(settings, water); }

  /// Our own methods serve the choices of the rule. PETSc solves if there are options, for a free constant and for
  /// SSOR.
  Method& method_for(const LinearSystem& system) {
    if (!settings.petsc_options.empty()) return kept->petsc;
    const SolverChoice choice = choose_solver(settings, traits_of(system, water));
    if (choice.preconditioner == PreconditionerName::cell_multigrid) {
      const bool is_free = settings.method == KrylovMethod::automatic;
      if (is_free && system.has_cells()) return kept->orthomin;
      return kept->petsc;
    }
    const bool is_swept = choice.method == KrylovMethod::bicgstab && choice.preconditioner == PreconditionerName::ssor;
    if (is_swept && !system.constant_is_free()) return kept->bicgstab;
    return kept->petsc;
  }

  struct Kept {
    Kept(const PressureSolverTable& settings, const SystemTraits& water) : petsc(settings, water, multigrid) {}

    KeptMultigrid multigrid;
    Bicgstab bicgstab;
    Orthomin orthomin{multigrid};
    PetscMethod petsc;
  };

  PressureSolverTable settings;
  SystemTraits water;
  std::unique_ptr<Kept> kept = std::make_unique<Kept>(settings, water);
};

LinearSolver::LinearSolver(const PressureSolverTable& settings, const SystemTraits& water)
    : methods_(std::make_unique<Methods>(settings, water)) {}

LinearSolver::~LinearSolver() = default;

void LinearSolver::forget() { methods_->forget(); }

double LinearSolver::tolerance() const { return methods_->settings.tolerance; }

bool LinearSolver::needs_cells() const {
  SystemTraits system = methods_->water;
  system.has_cells = true;
  return choose_solver(methods_->settings, system).preconditioner == PreconditionerName::cell_multigrid;
}

SolveReport LinearSolver::solve(LinearSystem& system, std::span<double> solution, double tolerance) {
  TAILWATER_ASSERT(solution.size() == system.size(), "the solution must have one entry per row");
  const SuspendFpTraps suspended;
  if (system.constant_is_free()) system.make_rhs_consistent();
  Solve solve(system, solution, tolerance);
  if (!solve.has_source()) {
    solve.begin_at_zero();
    return {};
  }
  solve.begin_at_guess();
  Method* method = &methods_->method_for(system);
  method->begin(system, solve.report().residual);
  if (solve.is_done()) return solve.report();

  int left = methods_->settings.max_iterations;
  for (int attempt = 1; !solve.is_done(); ++attempt) {
    const double residual_before = solve.report().residual;
    const MethodOutcome outcome = solve.improve(*method, left);
    left -= outcome.iterations;
    if (solve.is_done()) break;
    if (outcome.end == MethodOutcome::End::converged && attempt < max_attempts) {
      solve.ask_for_more();  // PETSc measures the preconditioned residual, and ours may contain rounding errors
    } else if (outcome.end == MethodOutcome::End::broke_down && solve.report().restarts == 0) {
      solve.restart();
      methods_->kept->petsc.change_to_gmres(system);
      method = &methods_->kept->petsc;
      left = methods_->settings.max_iterations;
    } else {
      throw no_convergence(system, solve, outcome, residual_before);
    }
  }
  if (system.constant_is_free()) take_out_mean(system, solution);
  return solve.report();
}

}  // namespace tailwater
