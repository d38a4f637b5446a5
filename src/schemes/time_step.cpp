#include <algorithm>
#include <cmath>

#include "schemes/verbs.h"

namespace tailwater {

namespace {

/// [s]; where neither water nor gravity limits the step, walls must not slip to and fro within it.
constexpr double longest_step_of_walls = 0.01;

}  // namespace

template <int Dim>
double largest_speed(const Flow<Dim>& flow) {
  double squared = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (flow.particles.is_fluid(i)) squared = std::max(squared, flow.particles.velocity[i].squaredNorm());
  }
  return std::sqrt(flow.ranks.largest(squared));
}

template <int Dim>
double next_time_step(const Flow<Dim>& flow) {
  const double speed = largest_speed(flow);
  double dt = flow.time_step_rule.largest(speed, flow.viscosity_law.at_speed(speed) + flow.noise_viscosity(speed));
  if (flow.wall_motion.moving().empty()) return dt;
  // What holds for the water holds for walls: alpha dx in a step. The way, not the speed, since a gate may start within
  // the step.
  dt = std::min(dt, longest_step_of_walls);
  const double longest_way = flow.time_step_rule.courant * flow.spacing;
  for (double way = 0.0; (way = flow.wall_motion.farthest_way(flow.time, flow.time + dt)) > longest_way;) {
    dt *= std::max(0.1, 0.99 * longest_way / way);
  }
  return dt;
}

template double largest_speed<2>(const Flow<2>&);
template double largest_speed<3>(const Flow<3>&);
template double next_time_step<2>(const Flow<2>&);
template double next_time_step<3>(const Flow<3>&);

}  // namespace tailwater
