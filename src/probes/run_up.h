// The run-up of the water on walls: probe "run-up".
//
// Water that is at most dx from one of the walls wets it, up to half a spacing along the wall above the particle's foot
// on it. `connected_m` is the height reached without a gap from the lowest wet place up, by particles with D + 3 others
// in their support, as for a connected front. `highest_m` is the height of any water on the wall. Heights are above the
// origin, against gravity; a dry wall has that of its lowest point. A gap of 4 dx is detected, and one of 2 dx or less
// is not.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Throws InputError if there is no gravity, and as chosen_shares does.
template <int Dim>
Reading<Dim> run_up_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
