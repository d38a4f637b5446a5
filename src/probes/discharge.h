// The discharge through a section, a flat opening drawn in the water: what passes it per time, and what has passed it
// since the start, both positive in the probe's direction.
//
// The discharge is the flux of the water within two spacings of the section, weighted by a tent, which counts a lattice
// exactly wherever it stands: a value without the steps of single particles. The volume is a count: particles that have
// passed (flow/sections.cpp) times their volumes, so it agrees with the water balance to the last particle.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Columns discharge_m3_per_s and volume_m3; in 2D per metre of width. Throws InputError, which names the probe, for a
/// section without extent, one that is not flat, or a direction that runs along it.
template <int Dim>
Reading<Dim> discharge_reading(const ProbeTable& probe, const CaseSpec& spec);

}  // namespace tailwater
