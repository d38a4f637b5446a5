// Patches of walls that do not move relative to each other, without parts that are drawn twice or have no water. Bodies
// are made of several walls that overlap or touch, as a barge of boxes. The parts of their surfaces inside another
// wall, or on it, border on no water.
#pragma once

#include <vector>

#include "case/spec.h"
#include "geometry/wall_patches.h"

namespace tailwater {

/// dx; a place that is less far from a wall lies on it.
inline constexpr double reach_of_touch = 0.1;

/// The patches without the following parts, cut into pieces of an eighth of the spacing. Of walls that lie on each
/// other and face the same way, those of the later wall. Of hulls of a floating body, those inside or on another hull
/// of the same body. Fixed hulls are cut later, at their present places (walls/wetted_patches.h).
template <int Dim>
std::vector<WallPatch<Dim>> outer_patches(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                          const std::vector<WallPatch<Dim>>& patches);

}  // namespace tailwater
