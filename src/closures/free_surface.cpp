#include "closures/free_surface.h"

#include <algorithm>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"

namespace tailwater {
namespace {

constexpr double thin_concentration = 0.85;
/// Between these mean concentrations `interior` rises from 0 to 1.
constexpr double interior_begins = 0.94;
constexpr double interior_is_full = 0.98;

}  // namespace

template <int Dim>
void mark_thin_water(const Particles<Dim>& particles, std::span<const double> concentration,
                     std::span<std::uint8_t> is_surface) {
  for_each(particles.owned,
           [&](std::size_t i) { is_surface[i] = particles.is_fluid(i) && concentration[i] < thin_concentration; });
}

template <int Dim>
void find_interior(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const double> concentration,
                   double W_0, std::span<double> interior) {
  for_each(pairs.owned(), [&](std::size_t i) {
    interior[i] = 0.0;
    if (!particles.is_fluid(i)) return;
    const double mean = mean_over_fluid(pairs, i, concentration, W_0);
    const double step = std::clamp((mean - interior_begins) / (interior_is_full - interior_begins), 0.0, 1.0);
    interior[i] = step * step * (3.0 - 2.0 * step);
  });
}

TAILWATER_IN_2D_AND_3D(mark_thin_water);
TAILWATER_IN_2D_AND_3D(find_interior);

}  // namespace tailwater
