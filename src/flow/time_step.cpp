#include <algorithm>

#include "base/for_each.h"
#include "flow/verbs.h"

namespace tailwater {
namespace {

/// [s]; even where neither water nor gravity limits the step, a wall must not move out and back within it.
constexpr double longest_step_of_walls = 0.01;

template <int Dim>
double largest_layer_diffusivity(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const double largest =
      largest_over(particles.owned, 0.0, [&](std::size_t i) { return particles.layer_viscosity[i]; });
  return spalart_allmaras::diffusivity(flow.setup.ranks.largest(largest));
}

}  // namespace

template <int Dim>
double next_time_step(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  double speed = largest_speed(flow);
  for (const OpenEnd<Dim>& end : setup.open_ends) {
    if (end.is_driven()) speed = std::max(speed, end.largest_speed(flow.state.time));
  }
  double viscosity = setup.viscosity_law.at_speed(speed) + setup.noise_viscosity(speed);
  if (setup.has_boundary_layers) viscosity += largest_layer_diffusivity(flow);
  double dt = setup.time_step_rule.largest(speed, viscosity);
  if (setup.wall_motion.moving().empty()) return dt;
  // Walls obey the same limit as the water: alpha dx in a step. The limit is on their way, not their speed, because a
  // gate may start within the step.
  dt = std::min(dt, longest_step_of_walls);
  const double longest_way = setup.time_step_rule.courant * setup.spacing;
  const double time = flow.state.time;
  const MotionState<Dim>& motion = flow.state.motion;
  for (double way = 0.0; (way = setup.wall_motion.farthest_way(time, time + dt, motion)) > longest_way;) {
    dt *= std::max(0.1, 0.99 * longest_way / way);
  }
  return dt;
}

template double next_time_step<2>(const Flow<2>&);
template double next_time_step<3>(const Flow<3>&);

}  // namespace tailwater
