// Shapes of plates, from which both their screens and their particles are made.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "geometry/boundary.h"
#include "geometry/mesh_surface.h"

namespace tailwater {

/// The wall nearest to the end of a plate.
struct WallBesidePlate {
  int face = -1;                                              ///< index into Boundary::faces; -1: none
  double distance = std::numeric_limits<double>::infinity();  ///< m; negative behind the wall
};

/// The nearest wall, except plates and the wall `except`.
template <int Dim>
WallBesidePlate wall_beside_plate(const Boundary<Dim>& boundary, const Vec<Dim>& x, int except = -1);

/// The front of a plate that consists of two triangles in a rectangle, without regard to other walls.
Screen<3> rectangle_of(const Boundary<3>& boundary, const WallPlate& plate);

/// An edge of the rim of a sheet beyond which the sheet has been extended.
struct DrawnOnEdge {
  Vec<3> from, to;              ///< m
  Vec<3> outer_from, outer_to;  ///< m; outer edge of the added strip
  int before = -1, after = -1;  ///< the edges that end at its begin and begin at its end; -1: none is extended
};

/// A sheet that has been extended beyond its rim.
struct WidenedSheet {
  TriangleMesh mesh;      ///< the triangles of the sheet come first
  std::vector<int> from;  ///< for each triangle, the triangle of the sheet in whose plane it lies
  std::vector<DrawnOnEdge> edges;
  std::vector<std::array<int, 2>> beyond;  ///< edges beyond which each triangle lies, two at a corner; -1: none
};

/// Extends a sheet by `reach` (m), each triangle in its own plane, beyond the edges of its rim for which
/// is_wanted(triangle, edge, out) is true, and around corners where two such edges meet.
WidenedSheet widened(const MeshSurface& sheet, double reach,
                     const std::function<bool(int, int, const Vec<3>&)>& is_wanted);

}  // namespace tailwater
