// Wendland's C2 kernel: W = s (1 - q)^4 (1 + 4 q), q = r/R. Its positive Fourier transform keeps particles from
// pairing. Wendland (1995); Dehnen & Aly (2012), table 1.
#pragma once

#include <algorithm>
#include <numbers>

#include "base/lanes.h"
#include "base/vec.h"

namespace tailwater {

template <int Dim>
struct WendlandC2 {
  explicit WendlandC2(double support_radius)
      : radius(support_radius),
        inverse_radius(1.0 / support_radius),
        scale((Dim == 2 ? 7.0 : 10.5) / (std::numbers::pi * power<Dim>(support_radius))) {}

  template <class Number>
  Number value(Number r) const {
    using One = LaneOf<Number>;
    const Number q = r * One(inverse_radius);
    const Number a = max_of(Number{}, One(radius) - r) * One(inverse_radius);  // 1 - q, and 0 exactly at the rim
    return One(scale) * a * a * a * a * (One(1.0) + One(4.0) * q);
  }

  template <class Number>
  Number steepness(Number r) const {
    using One = LaneOf<Number>;
    const Number a = max_of(Number{}, One(radius) - r) * One(inverse_radius);
    return One(20.0 * scale * inverse_radius * inverse_radius) * a * a * a;
  }

  double derivative(double r) const {
    const double q = r * inverse_radius;
    const double a = std::max(0.0, radius - r) * inverse_radius;
    return -20.0 * scale * inverse_radius * q * a * a * a;
  }

  double radius;
  double inverse_radius;
  double scale;
};

}  // namespace tailwater
