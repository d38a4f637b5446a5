// Velocities over the depth at a place: probe "velocity-profile".
//
// From the bed (water_column.h) to the surface of the connected water, the velocity is read (point.h) in the middle of
// pieces of equal height; the topmost piece is the remainder. So places have the same heights at all times, and the
// mean over the pieces is exact where the velocity is linear over the height.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// A row per piece, and one row of zeros where it is dry. Throws InputError as depth_reading does.
template <int Dim>
Reading<Dim> velocity_profile_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
