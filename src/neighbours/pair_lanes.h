// Loops over the pairs of a particle that process several pairs at once (base/lanes.h).
#pragma once

#include <cstddef>
#include <span>

#include "base/lane_loop.h"
#include "neighbours/pairs.h"

namespace tailwater {

/// Relative places and volumes of several neighbours of a particle.
template <int Dim>
struct PlaceLanes {
  VecLanes<Dim> d;      ///< m; r_i - r_j, as pairs.d returns it for one pair
  Lanes signed_volume;  ///< m^Dim; negative for wall particles, 0 in unused lanes

  Lanes volume() const { return max_of(signed_volume, -signed_volume); }
  Lanes volume_of_fluid() const { return max_of(signed_volume, Lanes{}); }
  /// `lanes` where the neighbours are fluid, and 0 elsewhere.
  Lanes of_fluid(Lanes lanes) const { return signed_volume > Lanes{} ? lanes : Lanes{}; }
};

/// Difference [m] along one axis between a particle at `own` and others at `places`, in `unit` [m].
[[gnu::always_inline]] inline Lanes difference(float unit, std::uint32_t own, IntegerLanes places) {
  using SignedLanes = std::int32_t __attribute__((vector_size(4 * lane_count)));
  return unit * __builtin_convertvector(reinterpret_cast<SignedLanes>(own - places), Lanes);
}

/// Several pairs of particle i: as many as there are lanes, or the rest of its row. `is_graded`: particles have several
/// spacings. If not, the functions that depend on the spacing compile to nothing.
template <int Dim, bool is_full, bool is_graded>
struct PairBatch {
  const Pairs<Dim>& pairs;
  std::size_t i;
  LaneRange<is_full> range;  ///< entries of the row
  LaneIndices j;             ///< the neighbours

  /// Values of a field at the neighbours. The field needs an entry for each of them.
  Lanes of(std::span<const double> field) const { return j(field.data()); }
  Lanes of(std::span<const float> field) const { return j(field.data()); }
  VecLanes<Dim> of(std::span<const Float4> field) const { return j.template vectors<Dim>(field.data()); }

  PlaceLanes<Dim> place() const { return place_of(j.numbers(pairs.place.data())); }
  /// Places of neighbours from `numbers`, which begin with the members of their Place and may hold more.
  template <std::size_t size>
  PlaceLanes<Dim> place_of(const std::array<Lanes, size>& numbers) const {
    using Own = Place<Dim>;
    constexpr std::size_t volume = offsetof(Own, signed_volume) / sizeof(float);
    const Own& own = pairs.place[i];
    PlaceLanes<Dim> lanes;
    for (int a = 0; a < Dim; ++a) {
      lanes.d.at[a] = difference(pairs.unit[a], own.at[a], reinterpret_cast<IntegerLanes>(numbers[a]));
    }
    lanes.signed_volume = range.only(numbers[volume]);
    return lanes;
  }

  /// Mean of both particles for each pair.
  Lanes relative_spacing() const {
    if constexpr (!is_graded) return in_all_lanes(1.0);
    if (pairs.has_one_spacing[i] != 0) return in_all_lanes(pairs.relative_spacing[i]);
    return 0.5F * (pairs.relative_spacing[i] + of(std::span<const float>(pairs.relative_spacing)));
  }
  /// m^2; squared distances, scaled as if all pairs had the spacing of the case.
  Lanes squared_over_spacing(Lanes squared) const {
    if constexpr (!is_graded) return squared;
    const Lanes inverse = 1.0F / relative_spacing();
    return squared * (inverse * inverse);
  }
  /// 1/m^Dim; values of the kernel, scaled as if all pairs had the spacing of the case.
  Lanes kernel_over_spacing(Lanes W) const {
    if constexpr (!is_graded) return W;
    return W * power_of<Dim>(relative_spacing());
  }
  /// Weights of neighbours in means: their volumes divided by that of a particle with the spacing of the case. 1 if all
  /// particles have one spacing.
  Lanes weight_in_means(const PlaceLanes<Dim>& place) const {
    if constexpr (!is_graded) return in_all_lanes(1.0);
    return place.volume() * pairs.inverse_cell;
  }

  /// m; between the particles, never 0.
  Lanes distance(const VecLanes<Dim>& d) const {
    return sqrt_of(max_of(d.dot(d), Lanes{} + pairs.min_distance_squared));
  }
  /// 1/m^(Dim+2); F = -(dW/dr)/r at these differences times the weights of the pairs, 0 in unused lanes.
  Lanes F(const VecLanes<Dim>& d) const {  // NOLINT(readability-identifier-naming): as in formulas
    if constexpr (!is_graded) return weighted(range.only(kernel_steepness(pairs.kernel_in_lanes, distance(d))));
    const Lanes inverse = 1.0F / relative_spacing();
    const Lanes steepness = kernel_steepness(pairs.kernel_in_lanes, distance(d) * inverse);
    return weighted(range.only(steepness * power_of<Dim + 2>(inverse)));
  }
  /// 1/m^Dim; W at these differences times the weights of the pairs.
  Lanes kernel_at(const VecLanes<Dim>& d) const {
    if constexpr (!is_graded) return weighted(kernel_value(pairs.kernel_in_lanes, distance(d)));
    const Lanes inverse = 1.0F / relative_spacing();
    return weighted(kernel_value(pairs.kernel_in_lanes, distance(d) * inverse) * power_of<Dim>(inverse));
  }
  /// 1/m^Dim; W_ij times the weight in means, for means over the fluid; 0 for walls and in unused lanes.
  Lanes kernel_of_fluid(const PlaceLanes<Dim>& where) const {
    return where.of_fluid(weight_in_means(where) * kernel_at(where.d));
  }
  Lanes kernel_of_fluid() const { return kernel_of_fluid(place()); }

  /// Writes `lanes` to the entries of these pairs in `row`, which holds all pairs of i. Returns the written values,
  /// with 0 in unused lanes.
  Lanes store(Lanes lanes, float* row) const { return range.store(lanes, row + (range.begin - pairs.begin(i))); }

 private:
  template <int exponent>
  static Lanes power_of(Lanes base) {
    Lanes product = base;
    for (int n = 1; n < exponent; ++n) product *= base;
    return product;
  }
  Lanes weighted(const Lanes& lanes) const {
    return pairs.weight.empty() ? lanes : lanes * range.load(pairs.weight.data());
  }
};

/// Pair k of particle i as a batch.
template <bool is_graded = false, int Dim>
PairBatch<Dim, false, is_graded> one_pair(const Pairs<Dim>& pairs, std::size_t i, std::size_t k) {
  const LaneRange<false> range{k, 1};
  return {pairs, i, range, range.neighbours(pairs.j.data())};
}
/// Calls body(batch) with pair k of particle i.
template <int Dim, class Body>
auto with_one_pair(const Pairs<Dim>& pairs, std::size_t i, std::size_t k, Body&& body) {
  return pairs.is_graded() ? body(one_pair<true>(pairs, i, k)) : body(one_pair(pairs, i, k));
}

template <int Dim>
float Pairs<Dim>::F(std::size_t i, std::size_t k) const {
  return with_one_pair(*this, i, k, [](const auto& pair) { return pair.F(pair.place().d)[0]; });
}

/// Calls body(batch), with a PairBatch, for the pairs of particle i in order. The sums of the body stay in registers.
template <int Dim, class Body>
[[gnu::always_inline, gnu::flatten]] inline void for_each_pair(const Pairs<Dim>& pairs, std::size_t i, Body&& body) {
  if (pairs.is_graded()) {
    for_each_lanes(pairs.begin(i), pairs.end(i), [&]<bool is_full>(LaneRange<is_full> range) {
      body(PairBatch<Dim, is_full, true>{pairs, i, range, range.neighbours(pairs.j.data())});
    });
    return;
  }
  for_each_lanes(pairs.begin(i), pairs.end(i), [&]<bool is_full>(LaneRange<is_full> range) {
    body(PairBatch<Dim, is_full, false>{pairs, i, range, range.neighbours(pairs.j.data())});
  });
}

}  // namespace tailwater
