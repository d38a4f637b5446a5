// Where floating bodies can touch: each other, and all other walls.
#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "motion/floating_body.h"

namespace tailwater {

/// Bodies are felt from so far, dx: two that approach each other come nearer by less in a step.
inline constexpr double contact_reach = 2.0;

/// Walls at rest are found from so far behind them, dx: by all of their particles.
inline constexpr double reach_behind_walls = 3.0;

/// Walls that bodies can touch and that move together: those that rest, those of one body, or one that moves as
/// prescribed. Alone, as drawn; filed as if they rested.
template <int Dim>
struct ContactSurface {
  Boundary<Dim> boundary;
  int wall = -1;  ///< index into Boundary::walls of one that moves as prescribed, else -1
  int body = -1;  ///< index of the body that they are of, or -1
};

template <int Dim>
struct ContactSurfaces {
  std::vector<ContactSurface<Dim>> each;      ///< all walls at rest are the first
  std::vector<std::vector<Vec<Dim>>> points;  ///< of each body, as drawn: its corners, and others 1.5 dx apart
};

/// Nothing at all for a case without bodies.
template <int Dim>
ContactSurfaces<Dim> make_contact_surfaces(const Boundary<Dim>& boundary, const std::vector<FloatingBody<Dim>>& bodies,
                                           double spacing);

}  // namespace tailwater
