// Where floating bodies can touch the walls that rest.
#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "motion/floating_body.h"

namespace tailwater {

template <int Dim>
struct ContactSurfaces {
  Boundary<Dim> resting;                      ///< the walls that rest, alone; filed
  std::vector<std::vector<Vec<Dim>>> points;  ///< of each body, as drawn: its corners, and others 1.5 dx apart
};

/// Nothing at all for a case without bodies.
template <int Dim>
ContactSurfaces<Dim> make_contact_surfaces(const Boundary<Dim>& boundary, const std::vector<FloatingBody<Dim>>& bodies,
                                           double spacing);

}  // namespace tailwater
