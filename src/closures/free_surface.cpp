#include "closures/free_surface.h"

#include <cmath>
#include <numbers>

#include "base/for_each.h"

namespace tailwater {
namespace {

constexpr double air_concentration = 0.85;
constexpr double near_surface_distance = 2.0;  // dx

constexpr double cone_reach = 2.3;  // dx
constexpr double cone_concentration = 0.95;
constexpr int cone_fewest_neighbours = 5;
const double cone_cosine = std::cos(0.5 * 105.0 * std::numbers::pi / 180.0);

constexpr double f35_kernel_sum = 0.80;
/// (F35 b): a flat regular surface reads 0.240 in 2D with the published kernel, 0.187 and more in 3D.
template <int Dim>
constexpr double f35_asymmetry = Dim == 2 ? 0.20 : 0.15;
/// (F35 c): 14 in 2D; the interior value of S_B2 goes with Dim^2.
template <int Dim>
constexpr double f35_b2_sum = 3.5 * Dim* Dim;

template <int Dim>
bool cone_is_empty(const SurfaceInput<Dim>& input, std::size_t i) {
  const Pairs<Dim>& pairs = input.pairs;
  const double steepness = input.concentration_gradient[i].norm();
  const bool has_normal = steepness * input.spacing > 1e-3;
  const Vec<Dim> outward = has_normal ? Vec<Dim>(-input.concentration_gradient[i] / steepness) : Vec<Dim>::Zero();
  int neighbours = 0;
  bool is_empty = has_normal;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    if (pairs.W[k] > 0.0) ++neighbours;
    if (pairs.r[k] < cone_reach * input.spacing && -pairs.e[k].dot(outward) > cone_cosine) is_empty = false;
  }
  if (neighbours < cone_fewest_neighbours || input.tensors[i].least_eigenvalue_A < least_sound_eigenvalue<Dim>)
    return true;
  return is_empty && input.concentration[i] < cone_concentration;
}

template <int Dim>
bool f35_holds(const SurfaceInput<Dim>& input, std::size_t i) {
  if (!input.tensors[i].has_inverse) return true;  // (d)
  const Pairs<Dim>& pairs = input.pairs;
  Vec<Dim> asymmetry = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    asymmetry += input.particles.volume[pairs.j[k]] * pairs.W[k] * pairs.e[k];
  }
  const double kernel_sum = input.concentration[i] * input.lattice_concentration;
  return kernel_sum <= f35_kernel_sum && asymmetry.norm() > f35_asymmetry<Dim> &&
         input.tensors[i].b2_sum > f35_b2_sum<Dim>;
}

}  // namespace

template <int Dim>
void find_free_surface(SurfaceTreatment test, const SurfaceInput<Dim>& input, std::span<std::uint8_t> is_surface) {
  for_each(input.pairs.owned(), [&](std::size_t i) {
    is_surface[i] = 0;
    if (!input.particles.is_fluid(i)) return;
    switch (test) {
      case SurfaceTreatment::air:
        is_surface[i] = input.concentration[i] < air_concentration;
        break;
      case SurfaceTreatment::cone:
        is_surface[i] = cone_is_empty(input, i);
        break;
      case SurfaceTreatment::farzin:
        is_surface[i] = f35_holds(input, i);
        break;
    }
  });
}

template <int Dim>
void find_near_surface(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing,
                       std::span<const std::uint8_t> is_surface, std::span<std::uint8_t> is_near) {
  for_each(pairs.owned(), [&](std::size_t i) {
    is_near[i] = is_surface[i];
    if (!particles.is_fluid(i)) return;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i) && !is_near[i]; ++k) {
      is_near[i] = is_surface[pairs.j[k]] && pairs.r[k] < near_surface_distance * spacing;
    }
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                           \
  template void find_free_surface<Dim>(SurfaceTreatment, const SurfaceInput<Dim>&, std::span<std::uint8_t>); \
  template void find_near_surface<Dim>(const Pairs<Dim>&, const Particles<Dim>&, double,                     \
                                       std::span<const std::uint8_t>, std::span<std::uint8_t>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
