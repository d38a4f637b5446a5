// Cubic spline on a support R = 2h (Monaghan & Lattanzio 1985; B5): with s = r/h,
// W = c (1 - 3/2 s^2 + 3/4 s^3) for s < 1, c/4 (2 - s)^3 for s < 2; in one piece, c/4 [(2 - s)+^3 - 4 (1 - s)+^3], x+
// the larger of x and 0.
#pragma once

#include <numbers>

#include "base/lanes.h"
#include "base/vec.h"

namespace tailwater {

template <int Dim>
struct CubicSpline {
  explicit CubicSpline(double support_radius)
      : radius(support_radius),
        scale((Dim == 2 ? 10.0 / 7.0 : 1.0) / (std::numbers::pi * power<Dim>(0.5 * support_radius))) {}

  template <class Number>
  Number value(Number r) const {
    using One = LaneOf<Number>;
    const Number s = One(2.0 / radius) * r;
    const Number a = max_of(Number{}, One(2.0) - s);
    const Number b = max_of(Number{}, One(1.0) - s);
    return One(0.25 * scale) * (a * a * a - One(4.0) * b * b * b);
  }

  template <class Number>
  Number derivative(Number r) const {
    using One = LaneOf<Number>;
    const Number s = One(2.0 / radius) * r;
    const Number a = max_of(Number{}, One(2.0) - s);
    return One(-1.5 * scale / radius) * (s < One(1.0) ? s * (One(4.0) - One(3.0) * s) : a * a);
  }

  template <class Number>
  Number steepness(Number r) const {
    return -derivative(r) / r;
  }

  double radius;
  double scale;
};

}  // namespace tailwater
