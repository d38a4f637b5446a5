// The largest, mean and last level of the water along a channel (2D) or over a plan (3D): probe "level-map".
//
// The level is the height of the connected surface above the origin, against gravity, as a depth probe computes it
// (water_column.h). It is read on lines in the middle of equal pieces; a dry line has the level of its bed. In 2D
// probes/NAME.map.csv has a row per line; in 3D probes/NAME.vtp has the pieces at their largest level.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// Throws InputError if there is no gravity, a place has no bed, or a plan has no extent in x or y.
template <int Dim>
Reading<Dim> level_map_reading(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
