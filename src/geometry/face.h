// Flat pieces of walls: segments in 2D, triangles in 3D.
#pragma once

#include <array>
#include <vector>

#include "base/box.h"
#include "base/vec.h"

namespace tailwater {

/// Two points nearer than this fraction of dx are the same corner.
inline constexpr double corner_tolerance = 1e-6;
/// [dx]; distance within which a place counts as on a wall that may be a mesh. Coordinates of meshes have single
/// precision, an error of some 1e-7 of the size of the case: this allows for a thousand spacings.
inline constexpr double mesh_tolerance = 1e-4;

/// One flat piece of a wall. `normal` has length 1 and points into the fluid. In 2D the fluid is on the left in the
/// direction from corner 0 to corner 1; in 3D the corners run counter-clockwise as seen from the fluid.
template <int Dim>
struct WallFace {
  std::array<Vec<Dim>, Dim> corners;
  Vec<Dim> normal;
  int wall = 0;           ///< index into Boundary::walls
  bool is_image = false;  ///< of a face that moves, in another period of the domain

  /// Distance from the face's plane, m; positive on the fluid side.
  double height(const Vec<Dim>& x) const { return normal.dot(x - corners[0]); }
  /// Length (2D, m) or area (3D, m^2).
  double measure() const;
  WallFace moved(const Vec<Dim>& by) const;
  /// The axis-parallel box around the face.
  Box<Dim> box() const;
};

/// The box around all faces; empty if there are none.
template <int Dim>
Box<Dim> box_around(const std::vector<WallFace<Dim>>& faces);

/// The point of a triangle nearest to a given point, and the part of the triangle that contains it. Edge 2 leads from
/// corner 2 to corner 0.
struct Foot {
  Vec<3> point = Vec<3>::Zero();
  int feature = -1;  ///< -1: the inside; 0 to 2: a corner; 3 to 5: an edge

  bool is_corner() const { return feature >= 0 && feature < 3; }
  bool is_edge() const { return feature >= 3; }
  int number() const { return feature % 3; }  ///< of the corner or edge
};

Foot closest_feature(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c, const Vec<3>& x);

/// Point of the face nearest to `x`.
Vec<2> closest_point(const WallFace<2>& face, const Vec<2>& x);
Vec<3> closest_point(const WallFace<3>& face, const Vec<3>& x);

/// Intersection of the face's plane with the line through two points, whose distances from the plane must differ.
template <int Dim>
Vec<Dim> meet(const WallFace<Dim>& face, const Vec<Dim>& from, const Vec<Dim>& to);

/// Whether the path from `from` to `to` passes through the face. A path that ends nearer to the face's plane than
/// `tolerance` (m) does not pass; a path within `tolerance` of the face's rim does.
template <int Dim>
bool crosses(const WallFace<Dim>& face, const Vec<Dim>& from, const Vec<Dim>& to, double tolerance);

}  // namespace tailwater
