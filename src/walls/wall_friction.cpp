#include "walls/wall_friction.h"

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "operators/laplacian_morris.h"

namespace tailwater {
namespace {

/// lambda c of a pair, k in the row of either particle, between a wall particle of `row` and one of `volume` [1/m^2].
template <int Dim>
double friction_weight(const WallScene<Dim>& scene, std::int32_t row, double volume, std::size_t k, double spacing) {
  return scene.walls.friction[row] *
         morris_laplacian_weight(volume, scene.pairs.F[k], scene.pairs.d[k].squaredNorm(), spacing);
}

}  // namespace

template <int Dim>
void add_wall_friction(const WallScene<Dim>& scene, const ViscosityLaw& law, double spacing,
                       std::span<const Vec<Dim>> V, std::span<const Vec<Dim>> no_slip,
                       std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration,
                       std::span<double> wall_viscosity) {
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
      if (scene.walls.friction[row] == 0.0) continue;
      const Vec<Dim> difference = no_slip[j] - velocity[i];
      const double weight = friction_weight(scene, row, particles.volume[j], k, spacing);
      sum += weight * (difference - scene.walls.particles.blocked[row] * difference);
      wall_velocity += weight * V[row];
      weights += weight;
    }
    const double viscosity = weights > 0.0 ? law.at_wall((velocity[i] - wall_velocity / weights).norm()) : 0.0;
    if (weights > 0.0) acceleration[i] += viscosity * sum;
    if (!wall_viscosity.empty()) wall_viscosity[i] = viscosity;
  });
}

template <int Dim>
void find_friction_on_walls(const WallScene<Dim>& scene, double spacing, std::span<const Vec<Dim>> no_slip,
                            std::span<const Vec<Dim>> velocity, std::span<const double> wall_viscosity,
                            std::span<Vec<Dim>> force) {
  const Particles<Dim>& particles = scene.particles;
  for_each(scene.pairs.owned(), [&](std::size_t w) {
    if (particles.is_fluid(w)) return;
    const auto row = particles.wall_row[w];
    const Vec<Dim> sum = sum_over_fluid(scene.pairs, particles, w, [&](std::int32_t i, std::size_t k) -> Vec<Dim> {
      const double weight = friction_weight(scene, row, particles.volume[i], k, spacing);
      return wall_viscosity[i] * weight * (velocity[i] - no_slip[w]);
    });
    force[w] = particles.volume[w] * (sum - scene.walls.particles.blocked[row] * sum);
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                    \
  template void add_wall_friction<Dim>(const WallScene<Dim>&, const ViscosityLaw&, double, std::span<const Vec<Dim>>, \
                                       std::span<const Vec<Dim>>, std::span<const Vec<Dim>>, std::span<Vec<Dim>>,     \
                                       std::span<double>);                                                            \
  template void find_friction_on_walls<Dim>(const WallScene<Dim>&, double, std::span<const Vec<Dim>>,                 \
                                            std::span<const Vec<Dim>>, std::span<const double>, std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
