// Outlets: flat openings, a segment in 2D and a rectangle in 3D, through which water leaves for good.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

template <int Dim>
struct Outlet {
  std::string name;
  Vec<Dim> corner = Vec<Dim>::Zero();   ///< m; the edges start here
  std::array<Vec<Dim>, Dim - 1> edges;  ///< m; of full length, at right angles
  Vec<Dim> normal = Vec<Dim>::Zero();   ///< unit vector, out of the case

  /// "outlet 'weir'": its name in messages.
  std::string label() const { return "outlet '" + name + "'"; }
  /// Distance beyond the outlet's plane, m; negative for water that has not reached it.
  double beyond(const Vec<Dim>& x) const { return normal.dot(x - corner); }
  /// Whether `x` is straight in front of the outlet or behind it.
  bool spans(const Vec<Dim>& x) const;
  /// Whether water at `x` has left.
  bool is_passed_by(const Vec<Dim>& x) const { return beyond(x) > 0.0 && spans(x); }
  /// The faces of a wall that would close the outlet, facing the water; they belong to no wall (-1).
  std::vector<WallFace<Dim>> as_faces() const;
};

/// The outlets of a case. Throws InputError, which names the outlet and the place, for an outlet without extent, one
/// that is not a flat axis-parallel rectangle (3D), or a direction that runs along it.
template <int Dim>
std::vector<Outlet<Dim>> make_outlets(const CaseSpec& spec);

}  // namespace tailwater
