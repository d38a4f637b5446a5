// Depth of the water along a line against gravity: probes "depth" and "profile".
//
// The bed is the highest wall face looking up on the line with water above it. From there c (water_share.h) is sampled
// every dx/4 up to the next face looking down, or past the highest particle; surfaces are where the piecewise linear
// curve passes 1/2. The bed counts as water below a layer that fills most of the free space at the bed, else as wall.
// With particles on the wall itself (scheme.walls = "pressure-rows") the starting lattice has its top row on the
// surface, not dx/2 below, and depths read dx/2 high.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

struct WaterColumn {
  double bed = 0.0;        ///< m; height of the bed above the origin
  double connected = 0.0;  ///< m; from the bed to the first surface
  double highest = 0.0;    ///< m; from the bed to the last surface
};

/// A depth probe: columns connected_m, highest_m. Throws InputError without gravity or bed below the place.
template <int Dim>
Reading<Dim> depth_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

/// A profile: a row per place from `from` to `to`, dx apart, with columns x_m (y_m), bed_m, connected_m, highest_m.
/// Throws InputError without gravity, or where a place has no bed.
template <int Dim>
Reading<Dim> profile_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
