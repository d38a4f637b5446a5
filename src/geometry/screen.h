// What a plate hides: water on one side of it does not feel the water on the other.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "base/vec.h"

namespace tailwater {

/// A straight cut through the plane of a screen, by coordinates along its axes: what is beyond it is not of the screen.
struct ScreenCut {
  std::array<double, 2> outwards{};                       ///< a unit vector; 0: nothing is cut off
  double most = std::numeric_limits<double>::infinity();  ///< m; how far the screen reaches in this direction
};

/// What a flat piece of a plate hides: water on one side of it does not feel the water on the other. It is a segment in
/// 2D, in 3D a rectangle or, with two cuts, a triangle.
template <int Dim>
struct Screen {
  Vec<Dim> corner;
  Vec<Dim> normal;
  std::array<Vec<Dim>, Dim - 1> along;               ///< unit vectors in its plane, at right angles
  std::array<std::array<double, 2>, Dim - 1> range;  ///< m; where it begins and ends along each, from the corner
  int wall = 0;
  int front = 0;  ///< indices into Boundary::faces, the front one on the side that the normal points to
  int back = 0;
  std::array<ScreenCut, Dim == 3 ? 2 : 0> cuts{};

  double height(const Vec<Dim>& x) const { return normal.dot(x - corner); }
  /// Whether the straight line from one place to another passes it.
  bool is_between(const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// The axis-parallel box around it.
  Eigen::AlignedBox<double, Dim> box() const;
  /// m; of `x` from the piece, or from the rectangle around it
  double distance(const Vec<Dim>& x) const;
};

/// Whether what is at one place does not feel what is at the other, because one of the screens `near` them, given by
/// index, is between them. If one of them is a wall particle of a plate, `plate` is its index into Boundary::walls,
/// else -1; such a particle stands for what its own plate hides, and is felt only through it.
template <int Dim>
bool is_hidden(std::span<const Screen<Dim>> screens, std::span<const int> near, const Vec<Dim>& from,
               const Vec<Dim>& to, int plate);

}  // namespace tailwater
