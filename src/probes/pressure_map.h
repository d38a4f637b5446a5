// The largest and the mean pressure over the run on patches of walls: probe "pressure-map", file probes/NAME.vtp.
//
// The pressure is that of wall_pressure.h at the centre of each patch. Its sums over particles are taken by every rank
// over its own particles and their periodic images, and added up: no rank needs the particles of others.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Throws InputError as chosen_shares does.
template <int Dim>
Reading<Dim> pressure_map_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
