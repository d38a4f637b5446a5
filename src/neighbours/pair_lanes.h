// What loops that take the pairs of a row in lanes (base/lanes.h) read of them.
#pragma once

#include "base/lanes.h"
#include "neighbours/pairs.h"

namespace tailwater {

/// r_i - r_j of several pairs of particle i and neighbours `j`, as pairs.d has them one by one.
template <int Dim, class Range>
inline VecLanes<Dim> differences(const Pairs<Dim>& pairs, const Range& range, const LaneIndices& j, std::size_t i) {
  VecLanes<Dim> d = j(pairs.position.data());
  for (int a = 0; a < Dim; ++a) d.at[a] = pairs.position[i][a] - d.at[a];
  const Lanes least_squared = in_all_lanes(pairs.least_distance * pairs.least_distance);
  if (any_of(d.dot(d) <= least_squared)) [[unlikely]] {
    for (int n = 0; n < lane_count; ++n) {
      const Vec<Dim> apart = pairs.d(i, range.entry(n));
      for (int a = 0; a < Dim; ++a) d.at[a][n] = apart[a];
    }
  }
  return d;
}

}  // namespace tailwater
