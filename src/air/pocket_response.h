// The answer q_k of the water's pressure to 1 Pa in pocket k (docs/theory/air.md): the pressure whose force on the
// water,
//
//   F = -grad q + chi_k grad 1,
//
// makes no velocity with a divergence. Gradient and divergence are those of the particles, which the matrix B of the
// pressure equation is near to and no more: what a step leaves would be mended in the next, one step behind the water,
// and the pocket's pulsation would gain energy. So q_k is carried on from step to step, and each step brings it nearer:
//
//   q <- q + B^-1 (-div F).
#pragma once

#include "air/enclosed_air.h"

namespace tailwater {

/// Gives walls the mean of the water beside them, as they have it of the pressure, and ghosts of water what their
/// owners have. Collective.
template <int Dim>
void extend_to_walls(const Flow<Dim>& flow, std::vector<double>& field);

/// chi_k of all particles. Collective.
template <int Dim>
std::vector<double> shares_of(const Flow<Dim>& flow, std::span<const PocketSide<Dim>> sides, int pocket);

/// Brings the response of the water to a pocket up to date, with the matrix of the pressure equation. Overwrites its
/// right-hand side. Returns the iterations of the solves. Collective.
template <int Dim>
int find_response(Flow<Dim>& flow, EnclosedAir<Dim>& air, std::span<const PocketSide<Dim>> sides, int pocket);

/// The response to the reference pocket of a sealed space: 1 in all of the space, less the responses to its other
/// pockets, which are up to date. The pressure of all air of the space together has no force. Collective.
template <int Dim>
void set_reference_response(const Flow<Dim>& flow, EnclosedAir<Dim>& air, int pocket);

}  // namespace tailwater
