// The discharge through a section, a flat opening drawn in the water: the volume that passes it per time, positive in
// the probe's direction. The probe also has the volume that has passed since the start.
//
// The volume is a count: particles that have passed (parts/section_counters.cpp) times their volumes, so it agrees with
// the water balance to the last particle. The discharge is its rate, averaged over the last time T, which the summary
// contains. Until a time T has passed, it is the average since the first reading, and the largest discharge leaves it
// out. It begins with the flux of the water within two spacings of the section. That flux alone would be wrong where
// the flow changes over such a distance: behind a sharp crest water falls below the section.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// The time T [s] over which the discharge of a probe is averaged; without gravity 0: from reading to reading. Throws
/// InputError as make_section does.
template <int Dim>
double discharge_mean_over(const ProbeTable& probe, const CaseSpec& spec);

/// Throws InputError, which names the probe, for a section without extent, one that is not flat, or a direction that
/// runs along it.
template <int Dim>
Reading<Dim> discharge_reading(const ProbeTable& probe, const CaseSpec& spec);

}  // namespace tailwater
