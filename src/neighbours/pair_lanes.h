// What loops that take the pairs of a row in lanes (base/lanes.h) read of them.
#pragma once

#include "base/lanes.h"
#include "neighbours/pairs.h"

namespace tailwater {

/// Where several neighbours of a particle are.
template <int Dim>
struct PlaceLanes {
  VecLanes<Dim> d;      ///< m; r_i - r_j, as pairs.d has them one by one
  Lanes signed_volume;  ///< m^Dim; negative of wall particles, and 0 in lanes left over

  Lanes volume() const { return max_of(signed_volume, -signed_volume); }
  Lanes volume_of_fluid() const { return max_of(signed_volume, Lanes{}); }
  /// `lanes` where the neighbours are fluid, and 0 elsewhere.
  Lanes of_fluid(Lanes lanes) const { return signed_volume > Lanes{} ? lanes : Lanes{}; }
};

/// The difference along one axis between a particle at `own` and others at `places`, in `unit` [m].
[[gnu::always_inline]] inline Lanes difference(float unit, std::uint32_t own, IntegerLanes places) {
  using SignedLanes = std::int32_t __attribute__((vector_size(4 * lane_count)));
  return unit * __builtin_convertvector(reinterpret_cast<SignedLanes>(own - places), Lanes);
}

/// Of neighbours of particle i of which `numbers` are those of their Place, maybe with others behind it.
template <int Dim, class Range, std::size_t size>
[[gnu::always_inline]] inline PlaceLanes<Dim> place_lanes(const Pairs<Dim>& pairs, const Range& range,
                                                          const std::array<Lanes, size>& numbers, std::size_t i) {
  PlaceLanes<Dim> lanes;
  const Place<Dim>& own = pairs.place[i];
  for (int a = 0; a < Dim; ++a) {
    lanes.d.at[a] = difference(pairs.unit[a], own.at[a], reinterpret_cast<IntegerLanes>(numbers[a]));
  }
  lanes.signed_volume = range.only(numbers[Dim]);
  return lanes;
}

/// Of neighbours `j` of particle i.
template <int Dim, class Range>
[[gnu::always_inline]] inline PlaceLanes<Dim> neighbour_places(const Pairs<Dim>& pairs, const Range& range,
                                                               const LaneIndices& j, std::size_t i) {
  return place_lanes<Dim>(pairs, range, j.numbers(pairs.place.data()), i);
}

/// pairs.value of pairs with these differences.
template <int Dim>
[[gnu::always_inline]] inline Lanes kernel_at(const Pairs<Dim>& pairs, const VecLanes<Dim>& d) {
  return kernel_value(pairs.kernel_in_lanes, sqrt_of(d.dot(d)));
}

/// pairs.gradient of pairs with these differences.
template <int Dim, class Range>
[[gnu::always_inline]] inline VecLanes<Dim> gradients(const Pairs<Dim>& pairs, const Range& range, VecLanes<Dim> d) {
  const Lanes F = range.load(pairs.F.data());
  for (int a = 0; a < Dim; ++a) d.at[a] *= -F;
  return d;
}

}  // namespace tailwater
