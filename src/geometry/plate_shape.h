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

/// Plates do not count.
template <int Dim>
WallBesidePlate wall_beside_plate(const Boundary<Dim>& boundary, const Vec<Dim>& x);

/// The front of a plate that is a rectangle of two triangles, without other walls.
Screen<3> rectangle_of(const Boundary<3>& boundary, const WallPlate& plate);

/// A sheet that has been drawn on beyond its rim.
struct WidenedSheet {
  TriangleMesh mesh;      ///< the triangles of the sheet come first
  std::vector<int> from;  ///< of each triangle: that of the sheet whose plane it goes on in
};

/// Draws a sheet on by `reach` (m), each triangle in its own plane, beyond the edges of its rim for which
/// is_wanted(from, to, out) is true, and around corners where two of these meet.
WidenedSheet widened(const MeshSurface& sheet, double reach,
                     const std::function<bool(const Vec<3>&, const Vec<3>&, const Vec<3>&)>& is_wanted);

}  // namespace tailwater
