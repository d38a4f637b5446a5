// The quadratic kernel of Farzin et al. (2014), (F8): W = s (1 - q)^2, q = r/R, with s = 6/(pi R^2) in 2D. The paper is
// 2D; in 3D the integral 4 pi R^3 (1/3 - 1/2 + 1/5) = 2 pi R^3/15 gives s = 15/(2 pi R^3).
#pragma once

#include <numbers>

#include "base/lanes.h"
#include "base/vec.h"

namespace tailwater {

template <int Dim>
struct FarzinKernel {
  explicit FarzinKernel(double support_radius)
      : radius(support_radius), scale((Dim == 2 ? 6.0 : 7.5) / (std::numbers::pi * power<Dim>(support_radius))) {}

  template <class Number>
  Number value(Number r) const {
    using One = LaneOf<Number>;
    const Number a = max_of(Number{}, One(1.0) - r / One(radius));
    return One(scale) * a * a;
  }

  template <class Number>
  Number derivative(Number r) const {
    using One = LaneOf<Number>;
    return One(-2.0 * scale / radius) * max_of(Number{}, One(1.0) - r / One(radius));
  }

  template <class Number>
  Number steepness(Number r) const {
    return -derivative(r) / r;
  }

  double radius;
  double scale;
};

}  // namespace tailwater
