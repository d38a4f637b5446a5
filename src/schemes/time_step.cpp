#include <algorithm>
#include <cmath>

#include "schemes/verbs.h"

namespace tailwater {

template <int Dim>
double largest_speed(const Flow<Dim>& flow) {
  double squared = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (flow.particles.is_fluid(i)) squared = std::max(squared, flow.particles.velocity[i].squaredNorm());
  }
  return std::sqrt(squared);
}

template <int Dim>
double next_time_step(const Flow<Dim>& flow) {
  const double speed = largest_speed(flow);
  return flow.time_step_rule.largest(speed, flow.viscosity_law.at_speed(speed) + flow.noise_viscosity(speed));
}

template double largest_speed<2>(const Flow<2>&);
template double largest_speed<3>(const Flow<3>&);
template double next_time_step<2>(const Flow<2>&);
template double next_time_step<3>(const Flow<3>&);

}  // namespace tailwater
