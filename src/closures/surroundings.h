// Surroundings of every particle at the present positions: missing neighbours, the surface, wet walls. `locate`
// computes them. They follow from the positions alone, so none of them is state.
#pragma once

#include <cstdint>
#include <vector>

#include "operators/interfaces.h"
#include "operators/pair_vectors.h"
#include "operators/support_terms.h"

namespace tailwater {

/// One entry per particle, ghosts included. Entries of ghosts are up to date only where the comment says "ghosts too".
template <int Dim>
struct Surroundings {
  std::vector<double> concentration;             ///< C/C_0, which is rho/rho_0 (B6); 1 for dummies; ghosts too
  std::vector<Vec<Dim>> concentration_gradient;  ///< 1/m; only if the formulation needs it
  std::vector<Packed<Dim>> first_moment;         ///< M of concentration.h; I for walls; ghosts too
  std::vector<double> wall_fluid_weight;         ///< 1/m^Dim; of wall particles: sum of W over the fluid in reach
  std::vector<std::uint8_t> is_wet;              ///< wall particles with fluid in reach; ghosts too
  std::vector<std::uint8_t> takes_part;          ///< fluid particles and wet wall particles; ghosts too
  std::vector<std::uint8_t> is_surface;          ///< ghosts too where the published rows depend on it
  std::vector<double> interior;                  ///< 0 near the surface, 1 inside (free_surface.h); robust: ghosts too
  std::vector<double> mean_interior;             ///< of owned fluid inside: mean over its fluid neighbours, weights W
  std::vector<double> wall_tension;              ///< Pa; by which owned wall particles hold water; empty: not at all
  std::vector<Vec<Dim>> crowding;                ///< 1/m; of owned fluid (concentration.h)
  PairVectorField<Dim> pair_vectors;             ///< data of the pair vectors (pair_vectors.h); ghosts too
  std::vector<Vec<Dim>> open_faces;              ///< 1/m; of owned particles inside: sum_j w_j a_ij
  Interfaces interfaces;                         ///< between liquids; ghosts too
  SupportTerms<Dim> support_terms;               ///< empty if all particles have one spacing
  bool are_current = false;                      ///< whether no particle has moved since they were computed

  void resize(std::size_t count, bool with_gradient) {
    concentration.resize(count);
    if (with_gradient) concentration_gradient.resize(count);
    first_moment.resize(count);
    wall_fluid_weight.resize(count);
    is_wet.resize(count);
    takes_part.resize(count);
    is_surface.resize(count);
    interior.resize(count);
  }
};

}  // namespace tailwater
