#include "closures/shifting.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

template <int Dim>
struct LindShift {
  Vec<Dim> direction;
  double mean_interior;  ///< over fluid neighbours
};

template <int Dim>
LindShift<Dim> lind_shift(const ShiftingLaw& law, const Pairs<Dim>& pairs, std::span<const double> interior,
                          std::size_t i) {
  const auto inverse_W = static_cast<float>(1.0 / law.W_spacing);
  VecLanes<Dim> sum{};
  Lanes interiors{};
  Lanes weights{};
  for_each_lanes(
      pairs.begin(i), pairs.end(i), [&](auto range) __attribute__((always_inline)) {
        const LaneIndices j = range.neighbours(pairs.j.data());
        const PlaceLanes<Dim> place = neighbour_places(pairs, range, j, i);
        const Lanes W = kernel_at(pairs, place.d);
        const Lanes ratio = W * inverse_W;
        const Lanes weight =
            place.volume() * (1.0F + 0.2F * ratio * ratio * ratio * ratio) * range.load(pairs.F.data());
        for (int a = 0; a < Dim; ++a) sum.at[a] += weight * place.d.at[a];
        const Lanes W_of_fluid = place.of_fluid(W);
        interiors += W_of_fluid * j(interior.data());
        weights += W_of_fluid;
      });
  const double weight = sum_of(weights);
  return {law.spacing * sum_of(sum), weight > 0.0 ? sum_of(interiors) / weight : 0.0};
}

template <int Dim>
Vec<Dim> farzin_direction(const Pairs<Dim>& pairs, std::size_t i) {
  double sum = 0.0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) sum += pairs.r(i, k);
  const double mean_distance = sum / static_cast<double>(pairs.end(i) - pairs.begin(i));
  Vec<Dim> direction = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const double ratio = mean_distance / pairs.r(i, k);
    direction += ratio * ratio * ratio * pairs.e(i, k);
  }
  return direction;
}

/// Share of its shift that a particle keeps: 0 in the three outermost rows, whose support the surface cuts, 1 where all
/// neighbours are inside. A flat surface reads a mean of `interior` over the neighbours of 0.26, 0.75, 0.98, 1 from the
/// second row on.
double kept_share(double interior, double mean_interior) {
  return interior * std::clamp(4.0 * mean_interior - 3.0, 0.0, 1.0);
}

}  // namespace

template <int Dim>
std::size_t compute_shift(const ShiftingLaw& law, double dt, double largest_speed, const Pairs<Dim>& pairs,
                          const Particles<Dim>& particles, std::span<const double> interior,
                          std::span<Vec<Dim>> shift) {
  return count_each(pairs.owned(), [&](std::size_t i) {
    shift[i].setZero();
    if (!particles.is_fluid(i) || pairs.begin(i) == pairs.end(i) || interior[i] == 0.0) return false;
    double kept = interior[i];
    if (law.kind == ShiftingKind::lind) {
      const LindShift<Dim> lind = lind_shift(law, pairs, interior, i);
      shift[i] = std::min(law.strength * largest_speed * dt, law.spacing) * lind.direction;
      kept = kept_share(interior[i], lind.mean_interior);
    } else {
      shift[i] = law.strength * particles.velocity[i].norm() * dt * farzin_direction(pairs, i);
    }
    shift[i] *= kept;
    const double ratio = shift[i].norm() / law.cap;
    shift[i] /= std::sqrt(1.0 + ratio * ratio);
    return ratio > 1.0;
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                               \
  template std::size_t compute_shift<Dim>(const ShiftingLaw&, double, double, const Pairs<Dim>&, \
                                          const Particles<Dim>&, std::span<const double>, std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
