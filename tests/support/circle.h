#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "case/spec.h"

namespace tailwater {

/// Corners of a regular polygon, counter-clockwise, on a circle of this radius (m) about `centre`.
inline std::vector<Coordinates> circle(int corners, double radius = 1.0, const Coordinates& centre = {0.0, 0.0}) {
  std::vector<Coordinates> points;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / corners;
    points.push_back({centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)});
  }
  return points;
}

}  // namespace tailwater
