// The density of the sample points of checks on a face.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/boundary.h"

namespace tailwater {

/// Points dx apart along the face's first edge; at least one, and at most 50, so that a long wall costs no more.
template <int Dim>
int samples_along(const WallFace<Dim>& face, double dx) {
  return static_cast<int>(std::clamp(std::ceil((face.corners[1] - face.corners[0]).norm() / dx), 1.0, 50.0));
}

/// One of these points; in 3D on the line from the middle of the edge between corners 0 and 2 to corner 1.
template <int Dim>
Vec<Dim> sample_of(const WallFace<Dim>& face, int k, int samples) {
  const double share = (k + 0.5) / samples;
  Vec<Dim> x = face.corners[0] + share * (face.corners[1] - face.corners[0]);
  if constexpr (Dim == 3) x += 0.5 * (1.0 - share) * (face.corners[2] - face.corners[0]);
  return x;
}

}  // namespace tailwater
