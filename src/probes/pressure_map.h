// The largest and the mean pressure over the run on patches of walls: probe "pressure-map", file probes/NAME.vtp.
//
// The pressure is that of wall_pressure.h at the centre of each patch. Every rank sums over its own particles and their
// periodic images, and the sums of all ranks are added: no rank needs the particles of others.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Throws InputError as chosen_shares does.
template <int Dim>
Reading<Dim> pressure_map_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
