// The response q_k of the water's pressure to 1 Pa in pocket k (docs/theory/air.md): the pressure whose force on the
// water,
//
//   F = -grad q + chi_k grad 1,
//
// makes no velocity with a divergence. Gradient and divergence are those of the particles, which the matrix B of the
// pressure equation only approximates. The next step would correct the remainder of one step, but later than the water
// moves, and the pulsation of the pocket would gain energy. So q_k is kept from step to step, and each step improves
// it:
//   q <- q + B^-1 (-div F).
#pragma once

#include "air/enclosed_air.h"

namespace tailwater {

/// Gives walls the mean of the water beside them, as for the pressure, and ghosts of water the values of their owners.
/// Collective.
template <int Dim>
void extend_to_walls(const Flow<Dim>& flow, std::vector<double>& field);

/// chi_k of all particles. Collective.
template <int Dim>
std::vector<double> shares_of(const Flow<Dim>& flow, std::span<const PocketSide<Dim>> sides, int pocket);

/// Updates the response of the water to a pocket, with the matrix of the pressure equation. Overwrites its right-hand
/// side. Returns the iterations of the solves. Collective.
template <int Dim>
int find_response(Flow<Dim>& flow, EnclosedAir<Dim>& air, std::span<const PocketSide<Dim>> sides, int pocket);

/// The response to the reference pocket of a sealed space: 1 in all of the space, less the responses to its other
/// pockets, which are up to date. The same pressure in all air of the space has no force. Collective.
template <int Dim>
void set_reference_response(const Flow<Dim>& flow, EnclosedAir<Dim>& air, int pocket);

}  // namespace tailwater
