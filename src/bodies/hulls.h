// Hulls whose gaps to other walls are treated apart (narrow_gaps.h): floating bodies, or fixed walls that water
// surrounds.
#pragma once

#include <span>

#include "geometry/wall_patches.h"
#include "motion/body_contact.h"

namespace tailwater {

/// dx; up to this width a gap changes the force on a hull.
inline constexpr double widest_gap = 3.0;

/// Borrows the data of a part.
template <int Dim>
struct Hulls {
  int count;
  std::span<const int> of_wall;                   ///< index of the hull of each wall, or -1
  std::span<const ContactSurface<Dim>> surfaces;  ///< of all walls, each hull's apart
  std::span<const WallPatch<Dim>> patches;        ///< of the hulls, at most dx long; they move with their faces
  /// Whether hulls can stand on other walls or in them. No water is where such a hull lies flat on a wall. A floating
  /// body on a bed always has a film of water below it.
  bool can_stand = false;
  double reach = widest_gap;  ///< dx; within it pieces of a hull are beside another wall
};

}  // namespace tailwater
