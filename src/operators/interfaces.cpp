#include "operators/interfaces.h"

#include <limits>

#include "base/for_each.h"
#include "neighbours/halo.h"

namespace tailwater {
namespace {

/// The nearest fluid particle of row i; -1 if there is none.
template <int Dim>
std::int32_t nearest_fluid(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::size_t i) {
  double nearest = std::numeric_limits<double>::infinity();
  std::int32_t found = -1;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    const double squared = pairs.d(i, k).squaredNorm();
    if (!particles.is_fluid(j) || squared >= nearest) continue;
    nearest = squared;
    found = j;
  }
  return found;
}

}  // namespace

template <int Dim>
Interfaces find_interfaces(const Pairs<Dim>& pairs, const Particles<Dim>& particles, const ParticleLiquids& liquids,
                           const Halo<Dim>& halo, double density) {
  Interfaces interfaces;
  interfaces.density.assign(particles.size(), 1.0F);
  const auto density_of = [&](std::size_t i) {
    return static_cast<float>(liquids.density[liquids.of(particles.id[i])] / density);
  };
  for_each(particles.size(), [&](std::size_t i) {
    if (particles.is_fluid(i)) {
      interfaces.density[i] = density_of(i);
    } else if (i < particles.owned) {
      const std::int32_t fluid = nearest_fluid(pairs, particles, i);
      if (fluid >= 0) interfaces.density[i] = density_of(fluid);
    }
  });
  halo.exchange(interfaces.density);
  interfaces.is_near.assign(particles.owned, 0);
  const double radius = kernel_radius(pairs.kernel);
  for_each(particles.owned, [&](std::size_t i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const bool is_other = interfaces.density[pairs.j[k]] != interfaces.density[i];
      if (is_other && pairs.d(i, k).squaredNorm() < radius * radius) interfaces.is_near[i] = 1;
    }
  });
  return interfaces;
}

#define TAILWATER_INSTANTIATE(Dim)                                                                      \
  template Interfaces find_interfaces(const Pairs<Dim>&, const Particles<Dim>&, const ParticleLiquids&, \
                                      const Halo<Dim>&, double);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
