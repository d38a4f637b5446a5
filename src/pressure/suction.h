// How far a particle may pull where there is air.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// What owned particle i may keep of a pressure below 0 where there is air: fluid the share of it that is inside, walls
/// what their model says.
template <int Dim>
double suction_share(const Flow<Dim>& flow, std::size_t i) {
  if (flow.is_solved_for(i)) return flow.here.interior[i];
  return flow.state.particles.is_fluid(i) || flow.setup.wall_traits.pulls ? 1.0 : 0.0;
}

}  // namespace tailwater
