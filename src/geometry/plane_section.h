// The open part of a plane between the walls of a case: the section of a river on a surveyed bed, of a pipe, of a tank.
#pragma once

#include <vector>

#include "geometry/boundary.h"

namespace tailwater {

/// The corners, in order, of the part of the plane through a point, at right angles to `normal`, that walls close
/// around it. Where they are open above, it ends at the height of the point along `up`, a unit vector in the plane.
/// Empty if they do not hold the point even so.
std::vector<Vec<3>> section_around(const Boundary<3>& boundary, const Vec<3>& point, const Vec<3>& normal,
                                   const Vec<3>& up, double spacing);

}  // namespace tailwater
