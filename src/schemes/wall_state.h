// Wall particles kept in step with the fluid, and how far either may pull.
#pragma once

#include "schemes/flow.h"

namespace tailwater {

/// Whether there is a surface, and missing neighbours are air: then p >= 0 near it.
template <int Dim>
bool has_air(const Flow<Dim>& flow) {
  return flow.scheme.surface == SurfaceTreatment::air && !flow.is_closed;
}

/// What owned particle i may keep of a pressure below 0 where there is air: fluid the share of it that is inside,
/// dummies nothing.
template <int Dim>
double suction_share(const Flow<Dim>& flow, std::size_t i) {
  if (flow.is_solved_for(i)) return flow.interior[i];
  return !flow.particles.is_fluid(i) && flow.walls.treatment == WallTreatment::dummies ? 0.0 : 1.0;
}

/// Sets the wall entries of `velocity` from its fluid entries and the walls' own velocity `V`, one entry per row of
/// their table, and brings ghosts up to date.
template <int Dim>
void update_wall_velocity(Flow<Dim>& flow, const std::vector<Vec<Dim>>& V, std::vector<Vec<Dim>>& velocity) {
  flow.neighbourhood.halo().exchange(velocity);
  set_wall_velocity<Dim>(flow.pairs(), flow.particles, flow.walls, flow.wall_fluid_weight, flow.is_wet, V,
                         flow.wall_mean, velocity);
  flow.neighbourhood.halo().exchange(flow.wall_mean, velocity);
}

/// What wall particle i's pressure exceeds that of its fluid neighbour f of pair k by: rho (g - a) . r_wf, hydrostatic
/// between the two as the wall feels it, a its own acceleration where it blocks the way; with it the wall row asks for
/// grad p . n = rho (g - a) . n (F37).
template <int Dim>
double hydrostatic_difference(const Flow<Dim>& flow, std::size_t i, std::size_t k) {
  const Vec<Dim> felt = flow.gravity - flow.wall_acceleration[flow.particles.wall_row[i]];
  return flow.density * flow.pairs().r[k] * felt.dot(flow.pairs().e[k]);
}

}  // namespace tailwater
