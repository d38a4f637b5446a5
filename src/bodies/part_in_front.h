// The part of a piece of a hull's surface that is in front of another wall, where the hull is drawn into this wall.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/wall_patches.h"

namespace tailwater {

/// Fraction of a patch in front of a wall, by pieces at most `longest` [m] long. `distance` [m] is that of the patch's
/// centre from the wall, negative behind it. distance_from(x, reach) is the distance of x, or `reach` if the wall is
/// farther.
template <int Dim, class DistanceFrom>
double part_in_front(const WallPatch<Dim>& patch, const Boundary<Dim>& boundary, double distance, double longest,
                     DistanceFrom&& distance_from) {
  const Vec<Dim> centre = patch.centre(boundary);
  double size = 0.0;  // m; no piece is farther from the centre
  for (int c = 0; c < Dim; ++c) size = std::max(size, (patch.corner(boundary, c) - centre).norm());
  if (distance < -size) return 0.0;
  const double reach = std::abs(distance) + size;  // finds the wall from each piece
  const std::vector<WallPatch<Dim>> pieces = pieces_of(patch, boundary, longest);
  const auto in_front = std::ranges::count_if(
      pieces, [&](const WallPatch<Dim>& piece) { return distance_from(piece.centre(boundary), reach) > 0.0; });
  return static_cast<double>(in_front) / static_cast<double>(pieces.size());
}

}  // namespace tailwater
