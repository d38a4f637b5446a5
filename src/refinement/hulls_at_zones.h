// Fixed hulls outside of all zones of refinement: their surroundings have the spacing of the case during the whole run.
#pragma once

#include <algorithm>

#include "base/box.h"
#include "geometry/boundary.h"
#include "geometry/images.h"
#include "refinement/spacing_field.h"

namespace tailwater {

/// dx; within it a force probe divides the force of a pair between the hull and another wall (docs/theory/probes.md).
inline constexpr double reach_of_shares = 5.5;

/// Whether the box around a wall that rests, `reach_of_shares` wider on all sides, is outside of all zones and borders.
template <int Dim>
bool is_outside_zones(const SpacingField<Dim>& field, const Boundary<Dim>& boundary, int wall, double spacing) {
  if (field.is_uniform()) return true;
  if (field.moves() || boundary.walls[wall].moves()) return false;
  Box<Dim> around;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (face.wall == wall) around.extend(face.box());
  }
  around.widen(reach_of_shares * spacing);
  return std::ranges::none_of(field.zones(), [&](const auto& zone) {
    Box<Dim> box = zone.box;
    bool meets = around.intersects(box);
    for (int axis = 0; axis < Dim; ++axis) {  // a zone may be infinitely long
      const auto& period = boundary.domain[axis];
      if (!period) continue;
      const double length = period->second - period->first;
      box.min()[axis] = std::max(box.min()[axis], period->first - length);
      box.max()[axis] = std::min(box.max()[axis], period->second + length);
    }
    visit_images<Dim>(boundary.domain, around, box, [&](const Vec<Dim>& /*moved*/) { meets = true; });
    return meets;
  });
}

}  // namespace tailwater
