// How densely checks sample a face.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/boundary.h"

namespace tailwater {

/// Points dx apart along the face's first edge; at least one, and at most 50, so that a long wall costs no more.
template <int Dim>
int samples_along(const WallFace<Dim>& face, double dx) {
  return std::clamp(static_cast<int>(std::ceil((face.corners[1] - face.corners[0]).norm() / dx)), 1, 50);
}

}  // namespace tailwater
