// What loops that take the pairs of a row in lanes (base/lanes.h) read of them.
#pragma once

#include "base/lanes.h"
#include "neighbours/pairs.h"

namespace tailwater {

/// r_i - r_j of several pairs of particle i and neighbours at `x`, as pairs.d has them one by one.
template <int Dim, class Range>
[[gnu::always_inline]] inline VecLanes<Dim> differences_from(const Pairs<Dim>& pairs, const Range& range,
                                                             const VecLanes<Dim>& x, std::size_t i) {
  VecLanes<Dim> d;
  for (int a = 0; a < Dim; ++a) d.at[a] = pairs.position[i][a] - x.at[a];
  const Lanes least_squared = in_all_lanes(pairs.least_distance * pairs.least_distance);
  if (any_of(d.dot(d) <= least_squared)) [[unlikely]] {
    for (int n = 0; n < lane_count; ++n) {
      const Vec<Dim> apart = pairs.d(i, range.entry(n));
      for (int a = 0; a < Dim; ++a) d.at[a][n] = apart[a];
    }
  }
  return d;
}

/// The same for neighbours `j`.
template <int Dim, class Range>
[[gnu::always_inline]] inline VecLanes<Dim> differences(const Pairs<Dim>& pairs, const Range& range,
                                                        const LaneIndices& j, std::size_t i) {
  return differences_from<Dim>(pairs, range, j(pairs.position.data()), i);
}

/// pairs.value of pairs with these differences.
template <int Dim>
[[gnu::always_inline]] inline Lanes kernel_at(const Pairs<Dim>& pairs, const VecLanes<Dim>& d) {
  return kernel_value(pairs.kernel, sqrt_of(d.dot(d)));
}

/// pairs.gradient of pairs of particle i and neighbours `j`.
template <int Dim, class Range>
[[gnu::always_inline]] inline VecLanes<Dim> gradients(const Pairs<Dim>& pairs, const Range& range, const LaneIndices& j,
                                                      std::size_t i) {
  VecLanes<Dim> d = differences(pairs, range, j, i);
  const Lanes F = range.load(pairs.F.data());
  for (int a = 0; a < Dim; ++a) d.at[a] *= -F;
  return d;
}

}  // namespace tailwater
