// Velocity and pressure of wall particles, kept in step with the fluid's.
#pragma once

#include "schemes/flow.h"

namespace tailwater {

/// Sets the wall entries of `velocity` from its fluid entries, and brings ghosts up to date.
template <int Dim>
void update_wall_velocity(Flow<Dim>& flow, std::vector<Vec<Dim>>& velocity) {
  flow.neighbourhood.halo().exchange(velocity);
  set_wall_velocity<Dim>(flow.pairs(), flow.particles, flow.walls, flow.wall_fluid_weight, flow.is_wet, flow.wall_mean,
                         velocity);
  flow.neighbourhood.halo().exchange(flow.wall_mean);
  flow.neighbourhood.halo().exchange(velocity);
}

/// Pressure that the fluid's neighbour f lends to the wall particle of pair k: p_f + rho g . r_wf, hydrostatic between
/// the two; with it the wall row asks for grad p . n = rho g . n (F37).
template <int Dim>
double hydrostatic_difference(const Flow<Dim>& flow, std::size_t k) {
  return flow.density * flow.pairs().r[k] * flow.gravity.dot(flow.pairs().e[k]);
}

}  // namespace tailwater
