// Wendland's C2 kernel: W = s (1 - q)^4 (1 + 4 q), q = r/R. Its positive Fourier transform keeps particles from
// pairing. Wendland (1995); Dehnen & Aly (2012), table 1.
#pragma once

#include <numbers>

#include "base/lanes.h"
#include "base/vec.h"

namespace tailwater {

template <int Dim, class Real = double>
class WendlandC2 {  // products in pairs, because loops wait for the longest chain of them
 public:
  explicit WendlandC2(double support_radius)
      : radius_(support_radius),
        inverse_radius_(1.0 / support_radius),
        scale_((Dim == 2 ? 7.0 : 10.5) / (std::numbers::pi * power<Dim>(support_radius))),
        slope_of_last_factor_(4.0 * scale_ * inverse_radius_),
        steepness_scale_(20.0 * scale_ * inverse_radius_ * inverse_radius_) {}

  Real radius() const { return radius_; }

  template <class Number>
  Number value(Number r) const {
    const Number a = distance_to_rim(r);
    const Number squared = a * a;
    return squared * squared * (scale_ + slope_of_last_factor_ * r);
  }

  template <class Number>
  Number steepness(Number r) const {
    const Number a = distance_to_rim(r);
    return (a * a) * (steepness_scale_ * a);
  }

 private:
  /// 1 - q, and 0 exactly at the rim
  template <class Number>
  Number distance_to_rim(Number r) const {
    return max_of(Number{}, radius_ - r) * inverse_radius_;
  }

  Real radius_;
  Real inverse_radius_;
  Real scale_;
  Real slope_of_last_factor_;
  Real steepness_scale_;
};

}  // namespace tailwater
