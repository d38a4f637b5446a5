// Cubic spline on a support R = 2h (Monaghan & Lattanzio 1985; B5): with s = r/h,
// W = c (1 - 3/2 s^2 + 3/4 s^3) for s < 1, c/4 (2 - s)^3 for s < 2.
#pragma once

#include <numbers>

#include "base/vec.h"

namespace tailwater {

template <int Dim>
struct CubicSpline {
  explicit CubicSpline(double support_radius)
      : radius(support_radius),
        scale((Dim == 2 ? 10.0 / 7.0 : 1.0) / (std::numbers::pi * power<Dim>(0.5 * support_radius))) {}

  double value(double r) const {
    const double s = 2.0 * r / radius;
    if (s >= 2.0) return 0.0;
    if (s < 1.0) return scale * (1.0 + s * s * (0.75 * s - 1.5));
    const double a = 2.0 - s;
    return 0.25 * scale * a * a * a;
  }

  double derivative(double r) const {
    const double s = 2.0 * r / radius;
    if (s >= 2.0) return 0.0;
    const double scale_over_h = 2.0 * scale / radius;
    if (s < 1.0) return scale_over_h * s * (2.25 * s - 3.0);
    const double a = 2.0 - s;
    return -0.75 * scale_over_h * a * a;
  }

  double radius;
  double scale;
};

}  // namespace tailwater
