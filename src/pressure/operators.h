// The scheme's choice of gradient and divergence, which share pairs and volumes: where both are the default they are
// negative adjoints of each other.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// Gradient of any field of pressure at fluid particle i [1/m of it]; 0 where the consistent operator is chosen and
/// does not exist: spray falls freely.
template <int Dim>
Vec<Dim> gradient_at(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure);

/// div of `velocity` at fluid particle i [1/s]; 0 where the consistent operator is chosen and does not exist.
template <int Dim>
double divergence_at(const Flow<Dim>& flow, std::size_t i, const std::vector<Vec<Dim>>& velocity);

/// div u at owned particles [1/s], 0 at walls, at the present positions.
template <int Dim>
std::vector<double> find_divergence(Flow<Dim>& flow);

/// rms of a field of owned entries over bulk fluid particles of all ranks. Collective.
template <int Dim>
double bulk_rms(const Flow<Dim>& flow, const std::vector<double>& field);

}  // namespace tailwater
