#include <algorithm>

#include "flow/verbs.h"

namespace tailwater {
namespace {

/// [s]; where neither water nor gravity limits the step, walls must not slip to and fro within it.
constexpr double longest_step_of_walls = 0.01;

}  // namespace

template <int Dim>
double next_time_step(const Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  const double speed = largest_speed(flow);
  double dt = setup.time_step_rule.largest(speed, setup.viscosity_law.at_speed(speed) + setup.noise_viscosity(speed));
  if (setup.wall_motion.moving().empty()) return dt;
  // What holds for the water holds for walls: alpha dx in a step. The way, not the speed, since a gate may start within
  // the step.
  dt = std::min(dt, longest_step_of_walls);
  const double longest_way = setup.time_step_rule.courant * setup.spacing;
  const double time = flow.state.time;
  for (double way = 0.0; (way = setup.wall_motion.farthest_way(time, time + dt)) > longest_way;) {
    dt *= std::max(0.1, 0.99 * longest_way / way);
  }
  return dt;
}

template double next_time_step<2>(const Flow<2>&);
template double next_time_step<3>(const Flow<3>&);

}  // namespace tailwater
