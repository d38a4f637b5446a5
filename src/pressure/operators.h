// Uses of the formulation's gradient and divergence by several stages.
#pragma once

#include <span>
#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// The force of each of these owned wall particles on the fluid by a pressure field (flow/formulation.h).
template <int Dim>
std::vector<Vec<Dim>> reactions_of_walls(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                                         const std::vector<double>& pressure);

/// div u at owned particles [1/s], 0 at walls, at the present positions. Collective.
template <int Dim>
std::vector<double> find_divergence(Flow<Dim>& flow);

/// rms of a field (owned entries) over the bulk fluid particles of all ranks. Collective.
template <int Dim>
double bulk_rms(const Flow<Dim>& flow, const std::vector<double>& field);

}  // namespace tailwater
