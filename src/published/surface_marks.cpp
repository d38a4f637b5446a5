#include "published/surface_marks.h"

#include <cmath>
#include <numbers>

#include "base/for_each.h"

namespace tailwater {
namespace {

constexpr double near_surface_distance = 2.0;  // dx
constexpr double cone_reach = 2.3;             // dx
constexpr double cone_concentration = 0.95;
constexpr int cone_fewest_neighbours = 5;
const double cone_cosine = std::cos(0.5 * 105.0 * std::numbers::pi / 180.0);

/// beta of (B21). The paper gives no number; this one distinguishes the rows of a flat surface
/// (docs/theory/two-step.md).
constexpr double min_density = 0.99;

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
bool cone_is_empty(const ConeInput<Dim>& input, std::size_t i) {
  const Pairs<Dim>& pairs = input.pairs;
  const double steepness = input.concentration_gradient[i].norm();
  const bool has_normal = steepness * input.spacing > 1e-3;
  const Vec<Dim> outward = has_normal ? Vec<Dim>(-input.concentration_gradient[i] / steepness) : Vec<Dim>::Zero();
  bool is_empty = has_normal;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    if (pairs.r(i, k) < cone_reach * input.spacing && -pairs.e(i, k).dot(outward) > cone_cosine) is_empty = false;
  }
  if (count_neighbours(pairs, i) < cone_fewest_neighbours ||
      input.tensors[i].min_eigenvalue_A < min_sound_eigenvalue<Dim>)
    return true;
  return is_empty && input.concentration[i] < cone_concentration;
}

}  // namespace

template <int Dim>
void mark_by_cone(const ConeInput<Dim>& input, const Particles<Dim>& particles, std::span<std::uint8_t> is_surface) {
  for_each(input.pairs.owned(),
           [&](std::size_t i) { is_surface[i] = particles.is_fluid(i) && cone_is_empty(input, i); });
}

template <int Dim>
void mark_by_density(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const double> concentration,
                     std::span<std::uint8_t> is_surface) {
  for_each(pairs.owned(), [&](std::size_t i) {
    is_surface[i] = concentration[i] < min_density ||
                    (particles.is_fluid(i) && count_neighbours(pairs, i) < fewest_neighbours_inside<Dim>);
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

TAILWATER_IN_2D_AND_3D(mark_by_cone);
TAILWATER_IN_2D_AND_3D(mark_by_density);
TAILWATER_IN_2D_AND_3D(find_interior_by_marks);

}  // namespace tailwater
