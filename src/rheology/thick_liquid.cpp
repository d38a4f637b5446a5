#include "rheology/thick_liquid.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/for_each.h"
#include "case/rheology.h"
#include "flow/balanced_pressure.h"
#include "flow/flow.h"
#include "flow/stages.h"
#include "geometry/wall_label.h"
#include "io/messages.h"
#include "motion/wall_motion.h"
#include "neighbours/halo.h"
#include "rheology/liquid_balances.h"
#include "rheology/pressure_lag.h"
#include "rheology/viscous_solve.h"

namespace tailwater {
namespace {

/// A solve ends when the energy norm of its error, before the last correction (viscous_solve.cpp), is this fraction of
/// that of the present velocity. An end at a fraction of the velocity instead would stop slow changes before a flow is
/// steady. With 0.01 of a guess that contains the present velocity, error in motions that dissipate little made a
/// liquid of 3e5 Pa s at rest explode.
constexpr double reduction = 3e-4;
constexpr int max_iterations = 500;

/// Passes in which the law follows the velocity of the same step, at most, and the end of each: a fraction of the error
/// of its guess, because the next pass has other viscosities, or of that of the present velocity.
constexpr int max_passes = 3;
constexpr double reduction_of_pass = 0.25;
constexpr double reduction_of_passes = 5e-3;
/// A pass is the last one if the next one would move less than this fraction of the change of the step.
constexpr double change_of_next_pass = 0.03;

/// Error over the velocity, both in the energy norm, below which rounding dominates: products are in single precision.
constexpr double min_error = 1e-5;

/// Only the solve for viscous forces contains this friction.
template <int Dim>
void refuse_coulomb_friction(const Boundary<Dim>& boundary) {
  for (std::size_t wall = 0; wall < boundary.walls.size(); ++wall) {
    if (boundary.walls[wall].coulomb_friction == 0.0) continue;
    throw CaseError(
        "coulomb-wall-without-thick-liquid",
        {"{}: slip = \"coulomb\" has no effect here, because this friction is computed only together with the "
         "implicit viscous forces of thick liquids, and the viscous forces of this case are explicit",
         wall_label(boundary, static_cast<int>(wall))},
        {"give slip = \"no-slip\", or a [[liquid]] with more viscosity or a yield stress"});
  }
}

}  // namespace

/// div v of the velocity found last.
template <int Dim>
void ThickLiquid<Dim>::find_expansion(const Flow<Dim>& flow) {
  expansion_.assign(flow.state.particles.owned, 0.0);
  std::vector<Vec<Dim>> beside_walls = velocity_;
  set_wall_velocities<Dim>(flow, walls_.velocity, beside_walls);
  flow.discretisation().find_divergence(flow, beside_walls, expansion_);
}

/// The pressure [Pa] that acts in a step, q + mu div v, at the velocity found last; the last q where this velocity is
/// that after a projection. Collective.
template <int Dim>
std::vector<double> ThickLiquid<Dim>::pressing_pressure(const Flow<Dim>& flow) {
  std::vector<double> pressure = flow.state.particles.pressure;
  if (!has_viscosity_) return pressure;
  find_expansion(flow);
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] == Role::water) pressure[i] += forces_.shared_viscosity()[i] * expansion_[i];
  });
  flow.halo().exchange(pressure);
  return pressure;
}

/// By the law, at the shear rates of a velocity that is up to date on ghosts.
template <int Dim>
void ThickLiquid<Dim>::find_viscosity(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity) {
  const Particles<Dim>& particles = flow.state.particles;
  shear_rate_.resize(particles.owned);
  forces_.find_shear_rates(flow, velocity, shear_rate_);
  const auto by_law = [&] {
    std::vector<double> viscosity(particles.owned, 0.0);
    for_each(particles.owned, [&](std::size_t i) {
      if (particles.is_fluid(i)) viscosity[i] = viscosity_at(liquid_of(flow, i), shear_rate_[i]);
    });
    return viscosity;
  };
  if (forces_.coulomb().has_walls()) {
    // The normal stress needs the viscosity of the last pass, ghosts too, or else that without slip.
    std::vector<double> last(forces_.viscosity());
    last.resize(particles.owned);
    forces_.set_viscosity(flow, has_viscosity_ ? last : by_law());
    forces_.slide(
        flow, walls_, [&](std::size_t i, double rate) { return viscosity_at(liquid_of(flow, i), rate); },
        pressing_pressure(flow), velocity, shear_rate_);
  }
  forces_.set_viscosity(flow, by_law());
  has_viscosity_ = true;
}

/// The fraction of the volume that is sheared faster than it creeps at the yield stress. Collective.
template <int Dim>
double ThickLiquid<Dim>::find_yielded_fraction(const Flow<Dim>& flow) const {
  const Particles<Dim>& particles = flow.state.particles;
  double yielded = 0.0;
  double all = 0.0;
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    all += particles.volume[i];
    const LiquidTable& liquid = liquid_of(flow, i);
    if (shear_rate_[i] * liquid.rest_viscosity >= liquid.yield_stress) yielded += particles.volume[i];
  });
  flow.setup.ranks.sum_each(yielded, all);
  return all > 0.0 ? yielded / all : 0.0;
}

/// A guess of v for particle i.
template <int Dim>
Vec<Dim> ThickLiquid<Dim>::guess_of(const Flow<Dim>& flow, Guess guess, std::size_t i) const {
  if (guess == Guess::present || i >= last_.size()) return flow.state.particles.velocity[i];
  if (guess == Guess::last || i >= before_last_.size()) return last_[i];
  return 2.0 * last_[i] - before_last_[i];
}

template <int Dim>
void ThickLiquid<Dim>::guess(const Flow<Dim>& flow) {
  velocity_ = flow.state.particles.velocity;
  if (guess_ == Guess::present) return;
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (flow.role[i] == Role::water) velocity_[i] = guess_of(flow, guess_, i);
  });
  flow.halo().exchange(velocity_);
}

/// The next step takes the guess that would have been the best one for this step. Collective.
template <int Dim>
void ThickLiquid<Dim>::remember(const Flow<Dim>& flow) {
  const std::size_t owned = flow.state.particles.owned;
  std::array<double, guess_count> errors{};
  for (int n = 0; n < guess_count; ++n) {
    errors[n] = sum_over(owned, 0.0, [&](std::size_t i) {
      if (flow.role[i] != Role::water) return 0.0;
      return (velocity_[i] - guess_of(flow, static_cast<Guess>(n), i)).squaredNorm();
    });
  }
  flow.setup.ranks.sum_each(errors[0], errors[1], errors[2]);
  int best = 0;
  for (int n = 1; n < guess_count; ++n) {
    if (errors[n] <= errors[best]) best = n;  // equal without earlier solutions: the higher guess is tried next
  }
  guess_ = forces_.coulomb().has_walls() ? Guess::last : static_cast<Guess>(best);
  before_last_ = std::move(last_);
  last_.assign(velocity_.begin(), velocity_.begin() + static_cast<std::ptrdiff_t>(owned));
}

template <int Dim>
void ThickLiquid<Dim>::reordered(Reordering /*how*/) {
  last_.clear();
  before_last_.clear();
  guess_ = Guess::present;
  contraction_ = 1.0;
  has_viscosity_ = false;
}

/// Whether the next pass would hardly change the velocity, compared with the whole step, after one that began at
/// `before`. Collective.
template <int Dim>
bool ThickLiquid<Dim>::is_last_pass(const Flow<Dim>& flow, std::span<const Vec<Dim>> before, int pass) {
  const bool has_changed_slip = forces_.has_changed_slip(flow, velocity_);
  const std::vector<Vec<Dim>>& start = flow.state.particles.velocity;
  double of_pass = sum_over(before.size(), 0.0, [&](auto i) { return (velocity_[i] - before[i]).squaredNorm(); });
  double of_step = sum_over(before.size(), 0.0, [&](auto i) { return (velocity_[i] - start[i]).squaredNorm(); });
  flow.setup.ranks.sum_each(of_pass, of_step);
  const double moved = std::sqrt(of_pass);
  if (pass > 0 && moved_ > 0.0) contraction_ = std::min(1.0, moved / moved_);
  moved_ = moved;
  return !has_changed_slip && contraction_ * moved <= change_of_next_pass * std::sqrt(of_step);
}

/// Solves with the viscosity of the guess in velocity_. Returns the iterations. Collective.
template <int Dim>
int ThickLiquid<Dim>::solve_pass(const Flow<Dim>& flow, std::span<const double> inertia,
                                 std::span<const Vec<Dim>> impulse) {
  find_viscosity(flow, velocity_);
  std::vector<Vec<Dim>> rhs(impulse.size());
  for_each(rhs.size(), [&](std::size_t i) { rhs[i] = impulse[i] + forces_.drag_of_walls(flow, i); });
  const double power =
      flow.setup.ranks.sum(sum_over(rhs.size(), 0.0, [&](std::size_t i) { return rhs[i].dot(velocity_[i]); }));
  const bool slides = forces_.coulomb().has_walls();
  const bool varies = slides || std::ranges::any_of(liquids_, varies_with_shear);
  const double of_scale = (varies ? reduction_of_passes : reduction) * scale_residual_;
  const ShellGoal goal{std::max(min_error * std::sqrt(std::abs(power)), of_scale),
                       varies && !slides ? reduction_of_pass : reduction, max_iterations};
  const ShellReport report = solve_viscous_step<Dim>(flow, forces_, inertia, rhs, goal, velocity_);
  if (scale_residual_ == 0.0) scale_residual_ = report.first_residual;
  has_converged_ = report.has_converged;
  return report.iterations;
}

/// Finds v. `force` [m/s^2] is that of gravity and the last pressure.
template <int Dim>
void ThickLiquid<Dim>::solve(const Flow<Dim>& flow, std::span<const Vec<Dim>> force, double dt,
                             std::span<const Vec<Dim>> predicted) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> inertia(particles.owned, 0.0);
  std::vector<Vec<Dim>> impulse(particles.owned, Vec<Dim>::Zero());
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    inertia[i] = flow.density_of(i) * particles.volume[i] / dt;
    impulse[i] = inertia[i] * (predicted[i] + dt * force[i]);
  });
  guess(flow);
  const bool slides = forces_.coulomb().has_walls();
  if (guess_ == (slides ? Guess::last : Guess::present)) scale_residual_ = 0.0;
  forces_.coulomb().begin_passes();
  iterations_ = 0;
  const int passes = slides || std::ranges::any_of(liquids_, varies_with_shear) ? max_passes : 1;
  std::vector<Vec<Dim>> before;
  for (int pass = 0; pass < passes; ++pass) {
    before.assign(velocity_.begin(), velocity_.begin() + static_cast<std::ptrdiff_t>(particles.owned));
    const int iterations = solve_pass(flow, inertia, impulse);
    iterations_ += iterations;
    if (iterations == 0 || is_last_pass(flow, before, pass)) break;
  }
  remember(flow);
  work_ = dt * sum_over(particles.owned, 0.0, [&](std::size_t i) {
            return flow.role[i] == Role::water ? velocity_[i].dot(inertia[i] * velocity_[i] - impulse[i]) : 0.0;
          });
}

/// The spin is the mean of the step.
template <int Dim>
void ThickLiquid<Dim>::find_wall_rates(const Flow<Dim>& flow, double dt) {
  const WallMotion<Dim>& motion = *flow.setup.wall_motion;
  const State<Dim>& state = flow.state;
  walls_.velocity = state.wall_velocity;
  motion.get_velocity(state.time + dt, state.motion, walls_.velocity);
  if (motion.moving().empty()) return;
  walls_.spin.assign(flow.walls.boundary.walls.size(), Mat<Dim>::Zero());
  for (const auto& moving : motion.moving()) {
    const Mat<Dim> rate = moving.mean_velocity(state.time, state.time + dt, state.motion).linear;
    walls_.spin[moving.wall] = rate * moving.at(state.time, state.motion).linear.transpose();
  }
}

template <int Dim>
void ThickLiquid<Dim>::change_prediction(const Flow<Dim>& flow, std::span<const Vec<Dim>> /*acceleration*/, double dt,
                                         std::span<Vec<Dim>> predicted) {
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  find_wall_rates(flow, dt);
  if (is_at_start_) return;
  forces_.locate(flow, walls_);
  std::vector<Vec<Dim>> force(particles.owned, Vec<Dim>::Zero());
  find_pressure_gradient<Dim>(flow, particles.pressure, force);
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) force[i] = setup.gravity - force[i] / setup.liquid.density;
  });
  solve(flow, force, dt, predicted);
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.role[i] == Role::water) predicted[i] = velocity_[i] - dt * force[i];
  });

  yielded_fraction_ = find_yielded_fraction(flow);

  find_expansion(flow);
}

/// Floating bodies are coupled to the pressure with this friction.
template <int Dim>
int ThickLiquid<Dim>::pose(Flow<Dim>& flow, std::span<const Vec<Dim>> /*predicted*/, double /*dt*/) {
  if (!is_at_start_ && flow.walls.forces.are_requested) {
    forces_.find_forces_on_walls(flow, walls_, velocity_, flow.walls.forces.friction);
  }
  return 0;
}

template <int Dim>
void ThickLiquid<Dim>::correct(Flow<Dim>& flow, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  const double viscosity = flow.setup.ranks.largest(largest_over(particles.owned, 0.0, [&](std::size_t i) {
    return particles.is_fluid(i) ? forces_.viscosity()[i] / flow.density_of(i) : 0.0;
  }));
  longest_step_ = longest_step_after(change_by_pressure<Dim>(flow, velocity_), dt,
                                     flow.setup.time_step_rule.largest(0.0, viscosity));
  for_each(particles.owned, [&](std::size_t i) {
    if (flow.role[i] == Role::water) particles.pressure[i] -= forces_.shared_viscosity()[i] * expansion_[i];
  });
  flow.halo().exchange(particles.pressure);
}

template <int Dim>
StepLimits ThickLiquid<Dim>::step_limits(const Flow<Dim>& /*flow*/) const {
  StepLimits limits;
  limits.step = longest_step_;
  return limits;
}

/// Viscosity and friction of the initial velocity.
template <int Dim>
void ThickLiquid<Dim>::stay(Flow<Dim>& flow) {
  forces_.locate(flow, walls_);
  velocity_ = flow.state.particles.velocity;
  flow.halo().exchange(velocity_);
  find_viscosity(flow, velocity_);
  yielded_fraction_ = find_yielded_fraction(flow);
  if (flow.walls.forces.are_requested) {
    forces_.find_forces_on_walls(flow, walls_, velocity_, flow.walls.forces.friction);
  }
}

template <int Dim>
Json ThickLiquid<Dim>::save() const {
  Json saved{{"longest_step", longest_step_}};
  if (forces_.coulomb().has_walls()) saved["residual"] = scale_residual_;
  return saved;
}

template <int Dim>
bool ThickLiquid<Dim>::restore(const Json& saved) {
  if (saved.at("longest_step").is_number()) saved.at("longest_step").get_to(longest_step_);
  if (saved.contains("residual")) scale_residual_ = saved.at("residual").get<double>();
  return true;
}

template <int Dim>
void ThickLiquid<Dim>::add_work(const Flow<Dim>& /*flow*/, const std::vector<double>& /*on_walls*/, double /*dt*/,
                                Works& works) const {
  works.viscous += work_;
}

template <int Dim>
std::vector<StepColumn> ThickLiquid<Dim>::step_columns() const {
  return {{"viscous_iterations", static_cast<double>(iterations_)}, {"yielded_fraction", yielded_fraction_}};
}

template <int Dim>
void ThickLiquid<Dim>::add_to_summary(const Flow<Dim>& flow, Json& summary) const {
  std::vector<std::string_view> names;
  for (const LiquidTable& liquid : liquids_) names.push_back(liquid.name);
  const bool are_several = liquids_.size() > 1;
  summary["liquid"] = {{"name", fmt::format("{}", fmt::join(names, " and "))},
                       {"rheology", are_several ? "several" : name_of(liquids_[0].rheology)},
                       {"viscous_iterations", iterations_},
                       {"yielded_fraction", yielded_fraction_}};
  if (are_several) summary["liquids"] = balances_of_liquids(flow, liquids_);
}

template <int Dim>
void ThickLiquid<Dim>::warn(const Flow<Dim>& flow) {
  if (has_converged_ || has_warned_) return;
  has_warned_ = true;
  const auto thickest = std::ranges::max_element(liquids_, {}, viscosity_at_rest);
  const bool has_constant = thickest->rheology == Rheology::newtonian || thickest->rheology == Rheology::carreau;
  tailwater::warn(
      "viscous-solve-not-converged",
      "the viscous forces at {:.6g} s did not converge within {} iterations; remedy: give liquid '{}' a smaller {}",
      flow.state.time, max_iterations, thickest->name, has_constant ? "viscosity" : "rest_viscosity");
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_thick_liquid(const CaseSpec& spec, const Setup<Dim>& setup,
                                             const Boundary<Dim>& boundary) {
  if (!setup.has_implicit_viscosity) {
    refuse_coulomb_friction(boundary);
    return nullptr;
  }
  const LiquidTable* const liquid = tailwater::liquid_of(spec);
  return std::make_unique<ThickLiquid<Dim>>(setup.liquids.are_several() ? spec.liquids
                                                                        : std::vector<LiquidTable>{*liquid});
}

template class ThickLiquid<2>;
template class ThickLiquid<3>;
TAILWATER_IN_2D_AND_3D(make_thick_liquid);

}  // namespace tailwater
