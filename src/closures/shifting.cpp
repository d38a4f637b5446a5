#include "closures/shifting.h"

#include <algorithm>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// Fraction of the shift that a particle keeps: 0 in the three outermost rows, whose support the surface cuts; 1 where
/// all neighbours are inside. Below a flat surface, the mean of `interior` over the neighbours is 0.26, 0.75, 0.98, 1
/// from the second row on.
double kept_share(double interior, double mean_interior) {
  return interior * std::clamp(4.0 * mean_interior - 3.0, 0.0, 1.0);
}

}  // namespace

template <int Dim>
std::size_t compute_shift(const ShiftingLaw& law, double dt, double largest_speed, const Pairs<Dim>& pairs,
                          const Particles<Dim>& particles, const Surroundings<Dim>& surroundings,
                          std::span<Vec<Dim>> shift) {
  return count_each(pairs.owned(), [&](std::size_t i) {
    shift[i].setZero();
    if (!particles.is_fluid(i) || pairs.begin(i) == pairs.end(i) || surroundings.interior[i] == 0.0) return false;
    const double relative = pairs.relative_spacing_of(i);
    const double spacing = law.spacing * relative;
    shift[i] = -std::min(law.strength * largest_speed * dt, spacing) * spacing * surroundings.crowding[i];
    return bound_shift<Dim>(shift[i], kept_share(surroundings.interior[i], surroundings.mean_interior[i]),
                            law.cap * relative);
  });
}

TAILWATER_IN_2D_AND_3D(compute_shift);

}  // namespace tailwater
