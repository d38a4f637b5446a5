// Loops over the pair vectors that published formulations share.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// Discretisation::find_divergence in the form of operators/divergence.h.
template <int Dim>
void find_standard_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity, std::span<double> divergence);

/// Discretisation::wall_reactions in the form of operators/gradient_conservative.h.
template <int Dim>
void find_conservative_pushes(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                              const std::vector<double>& pressure, std::span<Vec<Dim>> pushes);

/// Discretisation::reactions_seen_by_water in the form of operators/gradient_conservative.h.
template <int Dim>
void find_conservative_pushes_on_walls(const Flow<Dim>& flow, std::span<const std::size_t> water,
                                       std::span<const double> share, const std::vector<double>& pressure,
                                       std::span<Vec<Dim>> pushes);

}  // namespace tailwater
