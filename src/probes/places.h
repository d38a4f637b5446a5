// How probes are named in messages, and the places a stretch stands for.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/from_spec.h"

namespace tailwater {

inline std::string label(const ProbeTable& probe) { return fmt::format("probe '{}'", probe.name); }

/// Places from `from` to `to` at even distances of at most `step` [m]: the middles of equal pieces, so that their mean
/// is the mean over the stretch.
template <int Dim>
std::vector<Vec<Dim>> places_between(const ProbeTable& probe, double step) {
  const Vec<Dim> from = to_vec<Dim>(probe.from, label(probe), "from");
  const Vec<Dim> to = to_vec<Dim>(probe.to, label(probe), "to");
  // A stretch of a whole number of steps stays so in the presence of rounding.
  const int count = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step - 1e-6)));
  std::vector<Vec<Dim>> places;
  for (int k = 0; k < count; ++k) {
    places.push_back(from + (k + 0.5) / count * (to - from));
  }
  return places;
}

}  // namespace tailwater
