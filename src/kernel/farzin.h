// The quadratic kernel of Farzin et al. (2014), (F8): W = s (1 - q)^2, q = r/R, with s = 6/(pi R^2) in 2D. The paper is
// 2D; in 3D the integral 4 pi R^3 (1/3 - 1/2 + 1/5) = 2 pi R^3/15 gives s = 15/(2 pi R^3).
#pragma once

#include <numbers>

#include "base/lanes.h"
#include "base/vec.h"

namespace tailwater {

template <int Dim, class Real = double>
class FarzinKernel {
 public:
  explicit FarzinKernel(double support_radius)
      : radius_(support_radius), scale_((Dim == 2 ? 6.0 : 7.5) / (std::numbers::pi * power<Dim>(support_radius))) {}

  Real radius() const { return radius_; }

  template <class Number>
  Number value(Number r) const {
    const Number a = max_of(Number{}, Real(1.0) - r / radius_);
    return scale_ * a * a;
  }

  template <class Number>
  Number steepness(Number r) const {
    return (Real(2.0) * scale_ / radius_) * max_of(Number{}, Real(1.0) - r / radius_) / r;
  }

 private:
  Real radius_;
  Real scale_;
};

}  // namespace tailwater
