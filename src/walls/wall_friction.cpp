#include "walls/wall_friction.h"

#include <algorithm>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "closures/spalart_allmaras.h"
#include "closures/wall_law.h"
#include "operators/laplacian_morris.h"

namespace tailwater {
namespace {

/// lambda c of pair k in the row of either particle, i, between a wall particle of `row` and one of `volume` [1/m^2].
template <int Dim>
double friction_weight(const WallScene<Dim>& scene, std::int32_t row, double volume, std::size_t i, std::size_t k,
                       double spacing) {
  return scene.walls.friction[row] *
         morris_laplacian_weight(volume, scene.pairs.F(i, k), scene.pairs.d(i, k).squaredNorm(), spacing);
}

/// Calls visit(j, row, weight, k) for each particle of walls with friction in reach of fluid particle i.
template <int Dim, class Visit>
void visit_friction_pairs(const WallScene<Dim>& scene, double spacing, std::size_t i, Visit&& visit) {
  const Pairs<Dim>& pairs = scene.pairs;
  const Particles<Dim>& particles = scene.particles;
  if (pairs.sees_wall[i] == 0) return;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (particles.is_fluid(j)) continue;
    const auto row = particles.wall_row[j];
    if (scene.walls.friction[row] == 0.0) continue;
    visit(j, row, friction_weight(scene, row, particles.volume[j], i, k, spacing), k);
  }
}

template <int Dim>
Vec<Dim> along_wall(const WallScene<Dim>& scene, std::int32_t row, const Vec<Dim>& v) {
  return v - scene.walls.particles.blocked[row] * v;
}

/// Sets the stresses of a wall whose place and slip velocity are known. `spacing` [m] is that of the water there.
template <int Dim>
void apply_wall_law(const FrictionLaw& law, double spacing, double layer_viscosity, FrictionWall<Dim>& wall) {
  const double speed = wall.slip_velocity.norm();
  const bool may_be_thin = law.knows_layers && wall.distance < spacing;
  const WallLaw surface{law.viscosity, wall.roughness};
  const double u_tau = surface.turbulent_friction_velocity(speed, [&](double guess) {
    if (!may_be_thin) return wall.distance;
    const double layer = std::max(layer_viscosity, spalart_allmaras::seed(surface, guess));
    return std::min(wall.distance, spalart_allmaras::thickness(layer, guess));
  });
  const double laminar = law.viscosity * speed / wall.distance;
  wall.excess = std::max(0.0, u_tau * u_tau - laminar);
  wall.friction_velocity = std::sqrt(laminar + wall.excess);
}

/// A layer thinner than dx (spalart_allmaras.h) lowers the distance at which the wall law applies.
template <int Dim>
FrictionWall<Dim> find_friction_wall(const WallScene<Dim>& scene, const FrictionLaw& law, std::span<const Vec<Dim>> V,
                                     std::span<const Vec<Dim>> velocity, std::size_t i) {
  FrictionWall<Dim> wall;
  const double relative = scene.pairs.relative_spacing_of(i);
  visit_friction_pairs(scene, law.spacing, i, [&](std::int32_t, std::int32_t row, double weight, std::size_t k) {
    wall.weight += weight;
    wall.slip_velocity += weight * along_wall<Dim>(scene, row, velocity[i] - entry_of<Dim>(V, row));
    wall.distance += weight * (scene.pairs.d(i, k).dot(scene.walls.particles.normal[row]) - scene.walls.depth[row]);
    wall.roughness += weight * scene.walls.roughness[row];
  });
  if (wall.weight == 0.0) return {};
  wall.slip_velocity /= wall.weight;
  wall.distance = std::max(wall.distance / wall.weight, min_friction_distance * law.spacing * relative);
  wall.roughness /= wall.weight;
  apply_wall_law(law, law.spacing * relative, scene.particles.layer_viscosity[i], wall);
  return wall;
}

}  // namespace

template <int Dim>
std::vector<FrictionWall<Dim>> find_friction_walls(const WallScene<Dim>& scene, const FrictionLaw& law,
                                                   std::span<const Vec<Dim>> V, std::span<const Vec<Dim>> velocity) {
  std::vector<FrictionWall<Dim>> walls(scene.pairs.owned());
  for_each(walls.size(), [&](std::size_t i) {
    if (scene.particles.is_fluid(i)) walls[i] = find_friction_wall(scene, law, V, velocity, i);
  });
  return walls;
}

template <int Dim>
void add_wall_friction(const WallScene<Dim>& scene, const FrictionLaw& law, std::span<const FrictionWall<Dim>> walls,
                       std::span<const Vec<Dim>> no_slip, std::span<const Vec<Dim>> velocity,
                       std::span<Vec<Dim>> acceleration, std::span<double> excess_viscosity) {
  for_each(walls.size(), [&](std::size_t i) {
    const FrictionWall<Dim>& wall = walls[i];
    double k_i = 0.0;
    if (wall.weight > 0.0) {
      if (wall.is_turbulent()) {
        k_i = law.exchange_length * scene.pairs.relative_spacing_of(i) * wall.excess / wall.slip_velocity.norm();
        acceleration[i] -= k_i * wall.weight * wall.slip_velocity;
      }
      Vec<Dim> sum = Vec<Dim>::Zero();
      visit_friction_pairs(scene, law.spacing, i, [&](std::int32_t w, std::int32_t row, double weight, std::size_t) {
        sum += weight * along_wall<Dim>(scene, row, no_slip[w] - velocity[i]);
      });
      acceleration[i] += law.viscosity * sum;
    }
    if (!excess_viscosity.empty()) excess_viscosity[i] = k_i;
  });
}

template <int Dim>
void find_friction_on_walls(const WallScene<Dim>& scene, const FrictionLaw& law, std::span<const Vec<Dim>> V,
                            std::span<const Vec<Dim>> no_slip, std::span<const Vec<Dim>> velocity,
                            std::span<const double> excess_viscosity, std::span<Vec<Dim>> force) {
  const Particles<Dim>& particles = scene.particles;
  for_each(scene.pairs.owned(), [&](std::size_t w) {
    if (particles.is_fluid(w)) return;
    const auto row = particles.wall_row[w];
    const Vec<Dim> own = entry_of<Dim>(V, row);
    const Vec<Dim> sum = sum_over_fluid(scene.pairs, particles, w, [&](std::int32_t i, std::size_t k) -> Vec<Dim> {
      const double weight = friction_weight(scene, row, particles.volume[i], w, k, law.spacing);
      return weight * (law.viscosity * (velocity[i] - no_slip[w]) + excess_viscosity[i] * (velocity[i] - own));
    });
    force[w] = particles.volume[w] * along_wall<Dim>(scene, row, sum);
  });
}

TAILWATER_IN_2D_AND_3D(find_friction_walls);
TAILWATER_IN_2D_AND_3D(add_wall_friction);
TAILWATER_IN_2D_AND_3D(find_friction_on_walls);

}  // namespace tailwater
