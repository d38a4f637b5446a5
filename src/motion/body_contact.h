// Surfaces at which floating bodies can touch each other and all other walls, and between which narrow gaps can be.
#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "motion/floating_body.h"

namespace tailwater {

/// dx; distance within which bodies are detected. Two bodies approach each other by less than this in a step.
inline constexpr double contact_reach = 2.0;

/// dx; distance behind a wall at rest within which it is detected: all of its particles lie within it.
inline constexpr double reach_behind_walls = 3.0;

/// Walls that bodies can touch and that move together: all walls at rest, the walls of one body, or one wall with a
/// prescribed motion. As drawn, without other walls, and treated as if they rested.
template <int Dim>
struct ContactSurface {
  Boundary<Dim> boundary;
  int wall = -1;  ///< index into Boundary::walls of a wall with prescribed motion, else -1
  int body = -1;  ///< index of the body to which the walls belong, or -1
  int hull = -1;  ///< index of the hull to which the walls belong, or -1; of a body the same as `body`
};

template <int Dim>
struct ContactSurfaces {
  std::vector<ContactSurface<Dim>> each;      ///< the first contains all walls at rest
  std::vector<std::vector<Vec<Dim>>> points;  ///< of each body, as drawn: its corners, and further points 1.5 dx apart
};

/// Empty for a case without bodies.
template <int Dim>
ContactSurfaces<Dim> make_contact_surfaces(const Boundary<Dim>& boundary, const std::vector<FloatingBody<Dim>>& bodies,
                                           double spacing);

/// The surfaces of a case with fixed hulls; `hull_of_wall` has the hull of each wall, or -1. The walls of bodies are
/// left out.
template <int Dim>
std::vector<ContactSurface<Dim>> make_hull_surfaces(const Boundary<Dim>& boundary, const std::vector<int>& hull_of_wall,
                                                    const std::vector<int>& body_of_wall, double spacing);

}  // namespace tailwater
