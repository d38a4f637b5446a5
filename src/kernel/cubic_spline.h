// Cubic spline on a support R = 2h (Monaghan & Lattanzio 1985; B5): with s = r/h,
// W = c (1 - 3/2 s^2 + 3/4 s^3) for s < 1, c/4 (2 - s)^3 for s < 2; in one piece, c/4 [(2 - s)+^3 - 4 (1 - s)+^3], x+
// the larger of x and 0.
#pragma once

#include <numbers>

#include "base/lanes.h"
#include "base/vec.h"

namespace tailwater {

template <int Dim, class Real = double>
class CubicSpline {
 public:
  explicit CubicSpline(double support_radius)
      : radius_(support_radius),
        scale_((Dim == 2 ? 10.0 / 7.0 : 1.0) / (std::numbers::pi * power<Dim>(0.5 * support_radius))) {}

  Real radius() const { return radius_; }

  template <class Number>
  Number value(Number r) const {
    const Number s = (Real(2.0) / radius_) * r;
    const Number a = max_of(Number{}, Real(2.0) - s);
    const Number b = max_of(Number{}, Real(1.0) - s);
    return (Real(0.25) * scale_) * (a * a * a - Real(4.0) * b * b * b);
  }

  template <class Number>
  Number steepness(Number r) const {
    const Number s = (Real(2.0) / radius_) * r;
    const Number a = max_of(Number{}, Real(2.0) - s);
    return (Real(1.5) * scale_ / radius_) * (s < Real(1.0) ? s * (Real(4.0) - Real(3.0) * s) : a * a) / r;
  }

 private:
  Real radius_;
  Real scale_;
};

}  // namespace tailwater
