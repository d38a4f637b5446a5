// Searches among some of the walls of a boundary.
#pragma once

#include <cstdint>
#include <span>

#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// The nearest of the walls for which `is_part` is not 0, by index of the wall, within `search_distance` [m]. As
/// Boundary::nearest if there were no other walls.
template <int Dim>
NearestWall<Dim> nearest_among(const Boundary<Dim>& boundary, std::span<const std::uint8_t> is_part, const Vec<Dim>& x,
                               double search_distance);

/// Whether the path from one point to another passes through one of these walls (crosses in geometry/face.h).
template <int Dim>
bool is_crossed(const Boundary<Dim>& boundary, std::span<const std::uint8_t> is_part, const Vec<Dim>& from,
                const Vec<Dim>& to, double tolerance);

/// Whether water surrounds a closed wall of the case.
inline bool is_hull(const WallTable& wall) {
  const bool is_closed =
      wall.shape == WallShape::polygon || wall.shape == WallShape::box || wall.shape == WallShape::mesh;
  return is_closed && wall.fluid_side == FluidSide::outside;
}

}  // namespace tailwater
