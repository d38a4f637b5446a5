// The name of a probe in messages, and the places that represent a stretch.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/from_spec.h"

namespace tailwater {

inline std::string label(const ProbeTable& probe) { return fmt::format("probe '{}'", probe.name); }

/// Places from `from` to `to` at equal distances of at most `step` [m]. They are the midpoints of equal pieces, so that
/// their mean is the mean over the stretch.
template <int Dim>
std::vector<Vec<Dim>> places_between(const ProbeTable& probe, double step) {
  const Vec<Dim> from = to_vec<Dim>(probe.from, label(probe), "from");
  const Vec<Dim> to = to_vec<Dim>(probe.to, label(probe), "to");
  // A stretch of a whole number of steps keeps that number despite rounding.
  const int count = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step - 1e-6)));
  std::vector<Vec<Dim>> places;
  for (int k = 0; k < count; ++k) {
    places.push_back(from + (k + 0.5) / count * (to - from));
  }
  return places;
}

}  // namespace tailwater
