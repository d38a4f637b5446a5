// Zones in which waves die out: a body force against the water's velocity (docs/theory/waves.md).
#pragma once

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/from_spec.h"

namespace tailwater {

template <int Dim>
class DampingZone {
 public:
  explicit DampingZone(const DampingTable& table)
      : low_(to_vec<Dim>(table.min, "damping '" + table.name + "'", "min")),
        high_(to_vec<Dim>(table.max, "damping '" + table.name + "'", "max")),
        axis_(static_cast<int>(table.towards) / 2),
        grows_upwards_(static_cast<int>(table.towards) % 2 == 1),
        strength_(table.strength) {}

  /// The rate [1/s] at which water at `x` loses its velocity.
  double rate_at(const Vec<Dim>& x) const {
    if ((x.array() < low_.array()).any() || (x.array() > high_.array()).any()) return 0.0;
    const double from_low = (x[axis_] - low_[axis_]) / (high_[axis_] - low_[axis_]);
    const double share = grows_upwards_ ? from_low : 1.0 - from_low;
    return strength_ * share * share;
  }

 private:
  Vec<Dim> low_, high_;
  int axis_;
  bool grows_upwards_;
  double strength_;
};

}  // namespace tailwater
