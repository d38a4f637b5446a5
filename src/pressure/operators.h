// What several stages ask of the formulation's gradient and divergence.
#pragma once

#include <span>
#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// What each of these owned wall particles pushes the fluid with by a pressure field (flow/formulation.h).
template <int Dim>
std::vector<Vec<Dim>> reactions_of_walls(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                                         const std::vector<double>& pressure);

/// Calls visit(j, force [N]) for what water that is held (Role::stagnant) does to each particle j by their pair.
template <int Dim, class Visit>
void visit_forces_of_held_water(const Flow<Dim>& flow, const std::vector<double>& pressure, Visit&& visit) {
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: few are held
    if (flow.role[i] != Role::stagnant) continue;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      const double strength = particles.volume[i] * particles.volume[j] * (pressure[i] + pressure[j]);
      visit(j, Vec<Dim>(strength * flow.surroundings.pair_vectors.at(pairs, i, k)));
    }
  }
}

/// div u at owned particles [1/s], 0 at walls, at the present positions. Collective.
template <int Dim>
std::vector<double> find_divergence(Flow<Dim>& flow);

/// rms of a field (owned entries) over the bulk fluid particles of all ranks. Collective.
template <int Dim>
double bulk_rms(const Flow<Dim>& flow, const std::vector<double>& field);

}  // namespace tailwater
