#include "closures/free_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"

namespace tailwater {
namespace {

constexpr double air_concentration = 0.85;
constexpr double near_surface_distance = 2.0;  // dx
/// Between these mean concentrations `interior` rises from 0 to 1.
constexpr double interior_begins = 0.94;
constexpr double interior_is_full = 0.98;

constexpr double cone_reach = 2.3;  // dx
constexpr double cone_concentration = 0.95;
constexpr int cone_fewest_neighbours = 5;
const double cone_cosine = std::cos(0.5 * 105.0 * std::numbers::pi / 180.0);

/// Half the neighbours that a full lattice has within the published 2.4 dx: 20 in 2D, 56 in 3D. A flat surface has 12
/// and 38.
template <int Dim>
constexpr int fewest_neighbours_inside = Dim == 2 ? 10 : 28;

template <int Dim>
int count_neighbours(const Pairs<Dim>& pairs, std::size_t i) {
  int neighbours = 0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) neighbours += pairs.value(i, k) > 0.0 ? 1 : 0;
  return neighbours;
}

template <int Dim>
bool cone_is_empty(const SurfaceInput<Dim>& input, std::size_t i) {
  const Pairs<Dim>& pairs = input.pairs;
  const double steepness = input.concentration_gradient[i].norm();
  const bool has_normal = steepness * input.spacing > 1e-3;
  const Vec<Dim> outward = has_normal ? Vec<Dim>(-input.concentration_gradient[i] / steepness) : Vec<Dim>::Zero();
  bool is_empty = has_normal;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    if (pairs.r(i, k) < cone_reach * input.spacing && -pairs.e(i, k).dot(outward) > cone_cosine) is_empty = false;
  }
  if (count_neighbours(pairs, i) < cone_fewest_neighbours ||
      input.tensors[i].least_eigenvalue_A < least_sound_eigenvalue<Dim>)
    return true;
  return is_empty && input.concentration[i] < cone_concentration;
}

}  // namespace

template <int Dim>
void find_free_surface(SurfaceTreatment test, const SurfaceInput<Dim>& input, std::span<std::uint8_t> is_surface) {
  for_each(input.pairs.owned(), [&](std::size_t i) {
    is_surface[i] = 0;
    if (!input.particles.is_fluid(i) && test != SurfaceTreatment::density) return;
    switch (test) {
      case SurfaceTreatment::air:
        is_surface[i] = input.concentration[i] < air_concentration;
        break;
      case SurfaceTreatment::cone:
        is_surface[i] = cone_is_empty(input, i);
        break;
      case SurfaceTreatment::density:
        is_surface[i] =
            input.concentration[i] < input.least_density ||
            (input.particles.is_fluid(i) && count_neighbours(input.pairs, i) < fewest_neighbours_inside<Dim>);
        break;
    }
  });
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

template <int Dim>
void find_interior_by_marks(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing,
                            std::span<const std::uint8_t> is_surface, std::span<double> interior) {
  for_each(pairs.owned(), [&](std::size_t i) {
    bool is_near = !particles.is_fluid(i) || is_surface[i];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i) && !is_near; ++k) {
      is_near = is_surface[pairs.j[k]] && pairs.r(i, k) < near_surface_distance * spacing;
    }
    interior[i] = is_near ? 0.0 : 1.0;
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                            \
  template void find_free_surface<Dim>(SurfaceTreatment, const SurfaceInput<Dim>&, std::span<std::uint8_t>);  \
  template void find_interior<Dim>(const Pairs<Dim>&, const Particles<Dim>&, std::span<const double>, double, \
                                   std::span<double>);                                                        \
  template void find_interior_by_marks<Dim>(const Pairs<Dim>&, const Particles<Dim>&, double,                 \
                                            std::span<const std::uint8_t>, std::span<double>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
