#include "closures/shifting.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "neighbours/pair_lanes.h"

namespace tailwater {
namespace {

/// [1/dx]; a smaller |grad C| is that of an even set and has no direction to speak of.
constexpr double least_steepness = 1e-3;

template <int Dim>
Vec<Dim> lind_direction(const ShiftingLaw& law, const Pairs<Dim>& pairs, const Particles<Dim>& particles,
                        std::size_t i) {
  const double inverse_W = 1.0 / law.W_spacing;
  VecLanes<Dim> sum{};
  for_each_lanes(pairs.begin(i), pairs.end(i), [&](auto range) {
    const LaneIndices j = range.neighbours(pairs.j.data());
    const Lanes volume = range.only(j(particles.volume.data()));
    const Lanes ratio = range.load(pairs.W.data()) * inverse_W;
    const Lanes weight = volume * (1.0 + 0.2 * ratio * ratio * ratio * ratio) * range.load(pairs.F.data());
    const VecLanes<Dim> d = differences(pairs, range, j, i);
    for (int a = 0; a < Dim; ++a) sum.at[a] += weight * d.at[a];
  });
  return law.spacing * sum_of(sum);
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

/// Share of a shift's part along the surface's normal that particle i keeps: 0 in the three outermost rows, whose
/// support the surface cuts, 1 where all neighbours are inside. A flat surface reads a mean of `interior` over the
/// neighbours of 0.26, 0.75, 0.98, 1 from the second row on.
template <int Dim>
double normal_share(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const double> interior,
                    std::size_t i) {
  return interior[i] * std::clamp(4.0 * mean_over_fluid(pairs, particles, i, interior, 0.0) - 3.0, 0.0, 1.0);
}

}  // namespace

template <int Dim>
std::size_t compute_shift(const ShiftingLaw& law, double dt, double largest_speed, const Pairs<Dim>& pairs,
                          const Particles<Dim>& particles, std::span<const double> interior,
                          std::span<const Vec<Dim>> concentration_gradient, std::span<Vec<Dim>> shift) {
  return count_each(pairs.owned(), [&](std::size_t i) {
    shift[i].setZero();
    if (!particles.is_fluid(i) || pairs.begin(i) == pairs.end(i)) return false;
    if (law.kind == ShiftingKind::lind) {
      shift[i] = std::min(law.strength * largest_speed * dt, law.spacing) * lind_direction(law, pairs, particles, i);
    } else {
      shift[i] = law.strength * particles.velocity[i].norm() * dt * farzin_direction(pairs, i);
    }
    const double kept = law.kind == ShiftingKind::lind ? normal_share(pairs, particles, interior, i) : interior[i];
    if (kept < 1.0) {
      const double steepness = concentration_gradient[i].norm();
      if (steepness * law.spacing > least_steepness) {
        const Vec<Dim> normal = concentration_gradient[i] / steepness;
        shift[i] -= (1.0 - kept) * shift[i].dot(normal) * normal;
      }
    }
    const double ratio = shift[i].norm() / law.cap;
    shift[i] /= std::sqrt(1.0 + ratio * ratio);
    return ratio > 1.0;
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                   \
  template std::size_t compute_shift<Dim>(const ShiftingLaw&, double, double, const Pairs<Dim>&,                     \
                                          const Particles<Dim>&, std::span<const double>, std::span<const Vec<Dim>>, \
                                          std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
