// How much suction (pressure below 0) a particle may keep where there is air.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// Share of a pressure below 0 that owned particle i may keep where there is air: `interior` for fluid, 1 for fluid in
/// an end stretch, 0 for walls.
template <int Dim>
double suction_share(const Flow<Dim>& flow, std::size_t i) {
  if (flow.role[i] == Role::water) return flow.surroundings.interior[i];
  return flow.state.particles.is_fluid(i) ? 1.0 : 0.0;
}

/// Pa; suction that owned particle i, water or wall, may keep in full: what the pressure that pockets alone make there
/// is off that of their air. In the outermost rows this pressure makes a velocity with a divergence, and what mends
/// that pulls by as much at most. 0 without pockets.
template <int Dim>
double allowed_tension(const Flow<Dim>& flow, std::size_t i) {
  return flow.sides.response_deficit.empty() ? 0.0 : flow.sides.response_deficit[i];
}

}  // namespace tailwater
