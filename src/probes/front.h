// The position of the water front in a direction: the edge of the foremost fluid particle, dx/2 beyond its centre, once
// for all fluid and once for connected fluid, with enough other particles in its support.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Whether fluid particle `i` has at least `least` others in its support.
template <int Dim>
bool is_connected(const ProbeContext<Dim>& context, std::int32_t i, int least);

/// Coordinates along `direction`, 0 if there is no such fluid. Throws InputError for a direction of length 0.
template <int Dim>
Reading<Dim> front_reading(const ProbeTable& probe);

}  // namespace tailwater
