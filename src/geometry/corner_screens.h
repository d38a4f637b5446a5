// Plates that lean over the corner of a wall on which they stand, such as the edge of a step.
#pragma once

#include <optional>

#include "geometry/boundary.h"
#include "geometry/rim_ends.h"

namespace tailwater {

/// The screen that goes on from the foot of a plate into the corner of the walls there. Straight on, in the direction
/// `out`, the plate would lead past the corner, and water could pass below its foot. None if straight on is behind the
/// walls. `last` is the screen of the plate that ends there, in 2D at the point `x`, in 3D at its edge along `axis`
/// that begins at `x`.
std::optional<Screen<2>> screen_into_corner(const Boundary<2>& boundary, const Screen<2>& last, const Vec<2>& x,
                                            const Vec<2>& out, const Lengths& lengths);
std::optional<Screen<3>> screen_into_corner(const Boundary<3>& boundary, const Screen<3>& last, const Vec<3>& x,
                                            int axis, const Vec<3>& out, const Lengths& lengths);

}  // namespace tailwater
