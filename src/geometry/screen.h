// Walls that act on the water of one side only: two points with such a wall between them do not interact. These walls
// are plates, and the parts of other walls beside their free ends.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/vec.h"

namespace tailwater {

/// A straight cut through the plane of a screen, in coordinates along its axes. The screen ends at the cut.
struct ScreenCut {
  std::array<double, 2> outwards{};                       ///< a unit vector; 0: nothing is cut off
  double most = std::numeric_limits<double>::infinity();  ///< m; extent of the screen in this direction
};

/// A piece of the rim at which a wall ends in the water: a point in 2D, a segment in 3D.
template <int Dim>
using RimPiece = std::array<Vec<Dim>, Dim - 1>;

/// Distance [m] from the rim; infinite if there are no pieces.
template <int Dim>
double distance_to_rim(std::span<const RimPiece<Dim>> rim, const Vec<Dim>& x);

/// A corner in which two plates end, and nothing else. The sides of the smaller angle see each other through neither
/// plate. On the other side, lines pass both plates or none of them.
template <int Dim>
struct ScreenCorner {
  int number;  ///< the same for both plates, and different for each corner
  RimPiece<Dim> piece;
};

/// A flat piece of a wall that hides the points on one side of it from those on the other: a segment in 2D, in 3D a
/// rectangle or, with two cuts, a triangle.
///
/// The hidden fraction H decreases to 0 at a rim. If the line between two points passes the wall at the distance s
/// inside its rim (negative beyond the rim),
///
///   H = q^2 (3 - 2 q),   q = clamp((1 + s/fade)/2, 0, 1)
///
/// Screens beyond the rim continue the wall there, in its plane, as far as H is not 0. A corner of two plates is a rim
/// of both for lines that pass both plates or none of them: lines from one side of the corner to the same side.
template <int Dim>
struct Screen {
  Vec<Dim> corner;
  Vec<Dim> normal;
  std::array<Vec<Dim>, Dim - 1> along;               ///< unit vectors in its plane, at right angles
  std::array<std::array<double, 2>, Dim - 1> range;  ///< m; where it begins and ends along each axis, from the corner
  int wall = 0;
  int front = 0;  ///< indices into Boundary::faces; the front is on the side to which the normal points
  int back = 0;
  std::array<ScreenCut, Dim == 3 ? 2 : 0> cuts{};
  bool is_plate = true;                 ///< if false, the part beside a free end of a wall with water on one side
  bool is_beyond = false;               ///< beyond the rim, where there is no wall
  double plate_reach = 0.0;             ///< m; beyond a free end: distance up to which the wall is a plate
  double fade = 0.0;                    ///< m
  std::vector<RimPiece<Dim>> rim = {};  ///< the pieces within `fade` of the screen
  std::vector<ScreenCorner<Dim>> corners = {};  ///< corners with other plates; one if the screen is beyond a corner

  double height(const Vec<Dim>& x) const { return normal.dot(x - corner); }
  /// Whether the straight line from one point to another passes the screen.
  bool is_between(const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// Hidden fraction H between two points; 0 if the straight line between them does not pass the screen. At corners the
  /// result depends on other screens: visible_fraction.
  double hidden_fraction(const Vec<Dim>& from, const Vec<Dim>& to) const;
  bool is_beyond_corner() const { return is_beyond && !corners.empty(); }
  /// H for a line that passes the screen, if a corner were a free rim.
  double fraction_at(const ScreenCorner<Dim>& at, const Vec<Dim>& from, const Vec<Dim>& to) const;
  /// The axis-parallel box around the screen.
  Box<Dim> box() const;
  /// Distance [m] of `x` from the piece, or from the rectangle around it.
  double distance(const Vec<Dim>& x) const;

 private:
  /// H at this distance [m] inside the rim.
  double faded(double inside) const;
  /// Whether the line between two points passes the screen; if so, sets `passage` to the intersection.
  bool find_passage(const Vec<Dim>& from, const Vec<Dim>& to, Vec<Dim>& passage) const;
};

/// Visibility of a particle from water, if not through the screens of one wall, given by its index into
/// Boundary::walls.
inline constexpr int felt_past_screens = -1;  ///< water, and everything else that every screen hides
inline constexpr int felt_past_plates = -2;   ///< a wall particle: hidden by plates only
inline constexpr int never_felt = -3;

/// Fraction of the interaction between two points that the screens `near` them, given by index, leave. `felt` applies
/// to the wall particle of the two points, if there is one. It is the index of the wall through whose screens the
/// particle acts, because it replaces the water hidden by that wall, or one of the constants above. The wall particle
/// is at `to`, or at `from` if `is_wall_first`.
///
/// Water that several walls hide is replaced once, by the particles of the wall that the line from the other point
/// passes first. Screens behind that wall therefore do not reduce the interaction with its particles.
template <int Dim>
double visible_fraction(std::span<const Screen<Dim>> screens, std::span<const int> near, const Vec<Dim>& from,
                        const Vec<Dim>& to, int felt, bool is_wall_first = false);

/// Whether the screens `near` two points of water hide more than half of one from the other.
template <int Dim>
bool is_hidden(std::span<const Screen<Dim>> screens, std::span<const int> near, const Vec<Dim>& from,
               const Vec<Dim>& to, int felt = felt_past_screens) {
  return visible_fraction<Dim>(screens, near, from, to, felt) < 0.5;
}

}  // namespace tailwater
