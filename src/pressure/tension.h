// The tension (pressure below 0) that a particle may keep where there is air.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// Fraction of a pressure below 0 that owned particle i may keep where there is air: `interior` for water, 1 for water
/// whose pressure a part determines, 0 for walls.
template <int Dim>
double tension_share(const Flow<Dim>& flow, std::size_t i) {
  if (flow.role[i] == Role::water) return flow.surroundings.interior[i];
  return flow.state.particles.is_fluid(i) ? 1.0 : 0.0;
}

/// Tension [Pa] that particles, water or wall, keep in full; empty where there is none. Beside pockets of air it is the
/// difference between the pressure that the pockets alone make and that of their air. In the outermost rows this
/// pressure makes a velocity with a divergence, and the correction of that velocity has at most this tension.
/// Collective.
template <int Dim>
std::vector<double> allowed_tension(const Flow<Dim>& flow) {
  std::vector<double> tension;
  for (const auto& part : flow.parts) part->add_allowed_tension(flow, tension);
  return tension;
}

/// The lowest pressure [Pa] that owned particle i keeps in full, with the tension by which walls hold water.
template <int Dim>
double min_pressure(const Flow<Dim>& flow, const std::vector<double>& allowed, std::size_t i) {
  const std::vector<double>& of_walls = flow.surroundings.wall_tension;
  return -(allowed.empty() ? 0.0 : allowed[i]) - (of_walls.empty() ? 0.0 : of_walls[i]);
}

}  // namespace tailwater
