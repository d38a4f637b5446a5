// Solid walls as oriented faces: segments in 2D, triangles in 3D. Every face knows on which side the fluid is.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"

namespace tailwater {

/// One flat piece of a wall. `normal` has length 1 and points into the fluid.
template <int Dim>
struct WallFace {
  std::array<Vec<Dim>, Dim> corners;
  Vec<Dim> normal;
  int wall = 0;  ///< index into Boundary::walls
};

/// What a wall does to the fluid that touches it.
struct WallProperties {
  std::string name;
  double friction = 0.0;  ///< share of the no-slip wall stress: 0 free slip, 1 no slip
};

/// The place of a wall nearest to some point.
template <int Dim>
struct NearestWall {
  int face = -1;  ///< index into Boundary::faces; -1: no wall within the search distance
  Vec<Dim> point = Vec<Dim>::Zero();
  double signed_distance = 0.0;  ///< m; positive on the fluid side, negative behind the wall
};

template <int Dim>
struct Boundary {
  std::vector<WallFace<Dim>> faces;
  std::vector<WallProperties> walls;

  /// Nearest wall within `search_distance` of `x`. Where several faces are equally near (a shared corner), the sign is
  /// that of the face whose plane is farthest from `x`, which is right at convex and concave corners.
  NearestWall<Dim> nearest(const Vec<Dim>& x, double search_distance) const;
};

/// The walls of a case. Throws InputError for a wall with no extent, no normal, or points of the wrong dimension.
template <int Dim>
Boundary<Dim> make_boundary(const CaseSpec& spec);

}  // namespace tailwater
