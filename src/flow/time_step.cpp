#include <algorithm>

#include "flow/verbs.h"

namespace tailwater {
namespace {

/// [s]; even where neither water nor gravity limits the step, a wall must not move out and back within it.
constexpr double longest_step_of_walls = 0.01;

}  // namespace

template <int Dim>
double next_time_step(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  double speed = largest_speed(flow);
  for (const OpenEnd<Dim>& end : setup.open_ends) {
    if (end.is_driven()) speed = std::max(speed, end.largest_speed(flow.state.time));
  }
  double dt = setup.time_step_rule.largest(speed, setup.viscosity_law.at_speed(speed) + setup.noise_viscosity(speed));
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
