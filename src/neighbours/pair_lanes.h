// What loops that take the pairs of a row in lanes (base/lanes.h) read of them.
#pragma once

#include <span>

#include "base/lanes.h"
#include "neighbours/pairs.h"

namespace tailwater {

/// r_i - r_j of several pairs of particle i and neighbours `j`, at the positions for which the pairs were evaluated.
/// Neighbours' positions are in the cache, and pairs.d is not. Only pairs nearer than `near` [m] are read there,
/// because particles at one place are kept apart in it.
template <int Dim, class Range>
inline VecLanes<Dim> differences(const Pairs<Dim>& pairs, const Range& range, const LaneIndices& j,
                                 std::span<const Vec<Dim>> position, std::size_t i, double near) {
  VecLanes<Dim> d = j(position.data());
  for (int a = 0; a < Dim; ++a) d.at[a] = position[i][a] - d.at[a];
  if (any_of(d.dot(d) < in_all_lanes(near * near))) [[unlikely]]
    return range.entries()(pairs.d.data());
  return d;
}

}  // namespace tailwater
