#include "published/viscosity.h"

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "published/laplacian_consistent.h"
#include "published/laplacian_shao_lo.h"

namespace tailwater {

template <int Dim>
void add_shao_lo_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double eta_squared,
                           std::span<const double> density, std::span<const double> viscosity,
                           std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    acceleration[i] += sum_over_fluid(pairs, particles, i, [&](std::int32_t j, std::size_t k) -> Vec<Dim> {
      const double weight = shao_lo_laplacian_weight(particles.volume[j], density[i], density[j], pairs.r(i, k),
                                                     pairs.slope(i, k), eta_squared);
      return weight * 0.5 * (viscosity[i] + viscosity[j]) * (velocity[j] - velocity[i]);
    });
  });
}

template <int Dim>
void add_consistent_viscosity(const Pairs<Dim>& pairs, const Particles<Dim>& particles,
                              std::span<const Renormalisation<Dim>> tensors, std::span<const std::uint8_t> takes_part,
                              double spacing, std::span<const double> viscosity, std::span<const Vec<Dim>> velocity,
                              std::span<Vec<Dim>> acceleration) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    if (tensors[i].laplacian_is_sound()) {
      acceleration[i] += viscosity[i] * consistent_laplacian<Dim, Vec<Dim>>(pairs, i, tensors[i], particles.volume,
                                                                            takes_part, velocity, Vec<Dim>::Zero());
      return;
    }
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      if (!takes_part[j]) continue;
      sum += fallback_laplacian_weight(tensors[i], particles.volume[j], pairs.r(i, k), pairs.value(i, k), spacing) *
             (velocity[j] - velocity[i]);
    }
    acceleration[i] += viscosity[i] * sum;
  });
}

TAILWATER_IN_2D_AND_3D(add_shao_lo_viscosity);
TAILWATER_IN_2D_AND_3D(add_consistent_viscosity);

}  // namespace tailwater
