#include <algorithm>
#include <cmath>
#include <limits>

#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "flow/stages.h"
#include "motion/wall_motion.h"
#include "neighbours/pair_lanes.h"
#include "operators/graded_sums.h"

namespace tailwater {
namespace {

/// [s]; interval at which the positions of walls are sampled within a longer step, so that no wall moves out and back
/// undetected. Without gravity, where nothing else may limit the step, it is the longest step.
constexpr double time_between_looks = 0.01;

/// [dx]; largest reduction of the distance between two particles in a step. Particles that would meet at one point gain
/// energy (docs/theory/robustness.md).
constexpr double largest_approach_in_step = 0.9;

/// The largest speed [m/s] of the water where particles have several spacings: each speed is divided by the local
/// spacing and multiplied by the finest one.
template <int Dim>
double largest_speed_over_spacing(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  const double finest = setup.finest_spacing();
  return setup.ranks.largest(largest_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return 0.0;
    return particles.velocity[i].norm() * finest / setup.relative_spacing(particles.position[i]);
  }));
}

/// Whether walls or zones of refinement move.
template <int Dim>
bool something_moves(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  return !setup.wall_motion->moving().empty() || (setup.graded != nullptr && setup.graded->field().moves());
}

/// The largest distance [m] of a corner of a wall, or of a zone of refinement, from its present position, within the
/// next `dt` [s].
template <int Dim>
double largest_displacement_within(const Flow<Dim>& flow, double dt) {
  const double time = flow.state.time;
  const int looks = std::max(1, static_cast<int>(std::ceil(dt / time_between_looks)));
  double farthest = 0.0;
  for (int k = 1; k <= looks; ++k) {
    const double to = k == looks ? time + dt : time + k * dt / looks;
    farthest = std::max(farthest, flow.setup.wall_motion->largest_displacement(time, to, flow.state.motion));
    if (flow.setup.graded == nullptr) continue;
    const SpacingField<Dim>& field = flow.setup.graded->field();
    farthest = std::max(farthest, (field.displacement(to) - field.displacement(time)).norm());
  }
  return farthest;
}

}  // namespace

template <int Dim>
double largest_approach(Flow<Dim>& flow) {
  // If two particles approach each other fast enough to matter, one of them has at least half of that speed.
  const TimeStepRule rule = time_step_rule(flow);
  const double speed = largest_speed(flow);
  const double min_speed = 0.5 * largest_approach_in_step / rule.courant * rule.limiting_speed(speed);
  if (speed < min_speed) return 0.0;
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  const std::vector<Float4> velocity = as_float4<Dim>(particles.velocity);
  const auto finest = static_cast<float>(flow.setup.finest_spacing());
  const double largest = largest_over(particles.owned, 0.0, [&](std::size_t i) {
    if (!particles.is_fluid(i) || particles.velocity[i].norm() < min_speed) return 0.0;
    Lanes approach{};
    for_each_pair(pairs, i, [&](const auto& batch) {
      const PlaceLanes<Dim> place = batch.place();
      const Lanes rate = (batch.of(velocity) - velocity[i]).dot(place.d) / sqrt_of(place.d.dot(place.d));
      approach = max_of(approach, place.of_fluid(rate * finest / batch.relative_spacing()));
    });
    return largest_of(approach);
  });
  return flow.setup.ranks.largest(largest);
}

template <int Dim>
StepLimits step_limits(const Flow<Dim>& flow) {
  StepLimits limits;
  for (const auto& part : flow.parts) limits.include(part->step_limits(flow));
  return limits;
}

template <int Dim>
double step_of_water(const Flow<Dim>& flow, const StepLimits& limits) {
  const Setup<Dim>& setup = flow.setup;
  const double speed = std::max(largest_speed(flow), limits.speed);
  const TimeStepRule rule = time_step_rule(flow);
  const double of_noise = largest_noise_viscosity(flow, speed);
  const double viscosity =
      setup.liquid.viscosity.at_speed(speed) + setup.finest_spacing() * of_noise + limits.viscosity;
  const double limiting = setup.graded == nullptr ? speed : std::max(largest_speed_over_spacing(flow), limits.speed);
  const double dt = rule.largest(limiting, viscosity);
  // The rule counts no speed above its `fastest`, so two particles approach each other at no more than twice that.
  const double approach = std::min(flow.state.last_step.approach, 2.0 * rule.limiting_speed(speed));
  return approach > 0.0 ? std::min(dt, largest_approach_in_step * rule.spacing / approach) : dt;
}

template <int Dim>
double next_time_step(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  const StepLimits limits = step_limits(flow);
  double dt = std::min(step_of_water(flow, limits), limits.step);
  if (!something_moves(flow)) return dt;
  if (setup.time_step_rule.reference_speed == 0.0) dt = std::min(dt, time_between_looks);
  // Walls and zones obey the same limit as the water: alpha dx in a step. The limit is on their displacement, not their
  // speed, because a gate may start within the step.
  const double largest = setup.time_step_rule.courant * setup.time_step_rule.spacing;
  for (double displacement = 0.0; (displacement = largest_displacement_within(flow, dt)) > largest;) {
    dt *= std::max(0.1, 0.99 * largest / displacement);
  }
  return dt;
}

TAILWATER_IN_2D_AND_3D(largest_approach);
TAILWATER_IN_2D_AND_3D(step_limits);
TAILWATER_IN_2D_AND_3D(step_of_water);
TAILWATER_IN_2D_AND_3D(next_time_step);

}  // namespace tailwater
