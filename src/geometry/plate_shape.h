// The shapes of plates, from which both what they hide and their particles are made.
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
  double distance = std::numeric_limits<double>::infinity();  ///< m; below 0 behind it
};

/// Plates do not count, nor does the wall `except`.
template <int Dim>
WallBesidePlate wall_beside_plate(const Boundary<Dim>& boundary, const Vec<Dim>& x, int except = -1);

/// The front of a plate that is a rectangle of two triangles, without other walls.
Screen<3> rectangle_of(const Boundary<3>& boundary, const WallPlate& plate);

/// An edge of the rim of a sheet beyond which it has been drawn on.
struct DrawnOnEdge {
  Vec<3> from, to;              ///< m
  Vec<3> outer_from, outer_to;  ///< m; of the strip beyond it
  int before = -1, after = -1;  ///< the edges that end where it begins and begin where it ends; -1: none drawn on
};

/// A sheet that has been drawn on beyond its rim.
struct WidenedSheet {
  TriangleMesh mesh;      ///< the triangles of the sheet come first
  std::vector<int> from;  ///< of each triangle: that of the sheet whose plane it goes on in
  std::vector<DrawnOnEdge> edges;
  std::vector<std::array<int, 2>> beyond;  ///< the edges that a triangle is beyond, two at a corner; -1: none
};

/// Draws a sheet on by `reach` (m), each triangle in its own plane, beyond the edges of its rim for which
/// is_wanted(triangle, edge, out) is true, and around corners where two of these meet.
WidenedSheet widened(const MeshSurface& sheet, double reach,
                     const std::function<bool(int, int, const Vec<3>&)>& is_wanted);

}  // namespace tailwater
