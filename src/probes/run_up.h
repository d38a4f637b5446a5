// How high the water has run up walls: probe "run-up".
//
// Water that is at most dx from one of the walls wets it, up to half a spacing along the wall above the particle's foot
// on it. `connected_m` is the height that is reached from the lowest wet place up without a gap, by particles that have
// D + 3 others in their support, as a connected front has; `highest_m` is that of any water on the wall. Heights are
// above the origin, against gravity; of a dry wall that of its lowest point. A gap is found if it is 4 dx high, and one
// of 2 dx or less is none.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Throws InputError if there is no gravity, and as chosen_shares does.
template <int Dim>
Reading<Dim> run_up_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
