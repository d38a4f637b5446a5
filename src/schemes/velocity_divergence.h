// Divergence of a velocity field by the scheme's choice of operator.
#pragma once

#include "schemes/flow.h"

namespace tailwater {

/// div of `velocity` at fluid particle i [1/s]; 0 where the consistent operator is chosen and does not exist.
template <int Dim>
double divergence_at(const Flow<Dim>& flow, std::size_t i, const std::vector<Vec<Dim>>& velocity);

}  // namespace tailwater
