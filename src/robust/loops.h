// Loops over the pair vectors that a published formulation takes over.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// Discretisation::find_divergence in the form of operators/divergence.h.
template <int Dim>
void find_standard_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity, std::span<double> divergence);

/// Discretisation::find_pushes of operators/gradient_conservative.h.
template <int Dim>
void find_conservative_pushes(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                              const std::vector<double>& pressure, std::span<Vec<Dim>> pushes);

}  // namespace tailwater
