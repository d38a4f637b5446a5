#include "walls/wall_friction.h"

#include "base/for_each.h"
#include "operators/laplacian_morris.h"

namespace tailwater {

template <int Dim>
void add_wall_friction(const WallScene<Dim>& scene, const ViscosityLaw& law, double spacing,
                       std::span<const Vec<Dim>> V, std::span<const Vec<Dim>> no_slip,
                       std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration) {
  const Pairs<Dim>& pairs = scene.pairs;
  const Particles<Dim>& particles = scene.particles;
  for_each(pairs.owned(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    Vec<Dim> sum = Vec<Dim>::Zero();
    Vec<Dim> wall_velocity = Vec<Dim>::Zero();
    double weights = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      if (particles.is_fluid(j)) continue;
      const auto row = particles.wall_row[j];
      const double lambda = scene.walls.friction[row];
      if (lambda == 0.0) continue;
      const Vec<Dim> difference = no_slip[j] - velocity[i];
      const double weight =
          lambda * morris_laplacian_weight(particles.volume[j], pairs.F[k], pairs.d[k].squaredNorm(), spacing);
      sum += weight * (difference - scene.walls.particles.blocked[row] * difference);
      wall_velocity += weight * V[row];
      weights += weight;
    }
    if (weights > 0.0) acceleration[i] += law.at_wall((velocity[i] - wall_velocity / weights).norm()) * sum;
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                    \
  template void add_wall_friction<Dim>(const WallScene<Dim>&, const ViscosityLaw&, double, std::span<const Vec<Dim>>, \
                                       std::span<const Vec<Dim>>, std::span<const Vec<Dim>>, std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
