// Names of walls in messages.
#pragma once

#include "base/finding.h"
#include "geometry/boundary.h"

namespace tailwater {

/// Label for messages, such as "wall 'bed'" or "gate 'lock'".
template <int Dim>
CaseLabel wall_label(const Boundary<Dim>& boundary, int wall) {
  return CaseLabel(boundary.walls[wall].kind, boundary.walls[wall].name);
}

}  // namespace tailwater
