#include "parts/boundary_layers.h"

#include <algorithm>

#include "base/for_each.h"
#include "case/spec.h"
#include "closures/spalart_allmaras.h"
#include "flow/flow.h"
#include "neighbours/halo.h"
#include "walls/wall_friction.h"

namespace tailwater {
namespace {

/// Fraction of the molecular viscosity below which there is no layer, so that water that no layer has reached stays
/// free of it.
constexpr double min_layer_over_molecular = 1e-3;

/// Distance from the nearest wall with friction [m], measured from neighbour to neighbour: a particle computes its
/// distance from the known ones of its neighbours.
template <int Dim>
double distance_by_neighbours(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::size_t i) {
  double least = far_from_walls;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (particles.is_fluid(j)) least = std::min(least, particles.wall_distance[j] + pairs.r(i, k));
  }
  return least;
}

template <int Dim>
bool is_reached(const Pairs<Dim>& pairs, const std::vector<double>& layer_viscosity, std::size_t i) {
  if (layer_viscosity[i] > 0.0) return true;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    if (layer_viscosity[pairs.j[k]] > 0.0) return true;
  }
  return false;
}

/// nu~ [m^2/s] of fluid particle i after a step of dt. `d` is its distance from `wall`, or from the nearest one.
template <int Dim>
double next_layer_viscosity(const Flow<Dim>& flow, const FrictionWall<Dim>& wall, const Mat<Dim>& velocity_gradient,
                            double d, double dt, std::size_t i) {
  namespace sa = spalart_allmaras;
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  const double molecular = setup.liquid.viscosity.molecular;
  const double nu = particles.layer_viscosity[i];
  const bool is_beside_wall = wall.is_turbulent() && d < setup.scale.spacing * flow.pairs().relative_spacing_of(i);
  const double seed = is_beside_wall ? sa::seed({molecular, wall.roughness}, wall.friction_velocity) : 0.0;
  double rate = 0.0;
  double destruction = 0.0;
  if (nu > 0.0) {
    if (wall.is_turbulent()) {
      const double height = is_beside_wall ? std::min(d, sa::thickness(nu, wall.friction_velocity)) : d;
      rate = wall.friction_velocity / (von_karman * height);
    } else {
      rate = sa::modified_rate(shear_rate<Dim>(velocity_gradient), nu, molecular, d);
    }
    destruction = sa::destruction_rate(rate, nu, d);
  }
  const double diffusion = sa::diffusion(flow.pairs(), particles, molecular, setup.scale.spacing, i);
  const double next = (nu + dt * (sa::c_b1 * rate * nu + diffusion)) / (1.0 + dt * destruction);
  return next < min_layer_over_molecular * molecular ? seed : std::max(next, seed);
}

}  // namespace

template <int Dim>
StepLimits BoundaryLayers<Dim>::step_limits(const Flow<Dim>& flow) const {
  const Particles<Dim>& particles = flow.state.particles;
  const double largest =
      largest_over(particles.owned, 0.0, [&](std::size_t i) { return particles.layer_viscosity[i]; });
  return {.viscosity = spalart_allmaras::diffusivity(flow.setup.ranks.largest(largest))};
}

template <int Dim>
void BoundaryLayers<Dim>::add_viscosity(const Flow<Dim>& flow, std::span<double> viscosity) const {
  const std::vector<double>& layer = flow.state.particles.layer_viscosity;
  const double molecular = flow.setup.liquid.viscosity.molecular;
  for_each(viscosity.size(),
           [&](std::size_t i) { viscosity[i] += spalart_allmaras::eddy_viscosity(layer[i], molecular); });
}

template <int Dim>
void BoundaryLayers<Dim>::follow_friction(Flow<Dim>& flow, std::span<const FrictionWall<Dim>> walls,
                                          std::span<const Mat<Dim>> velocity_gradient, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  viscosity_.assign(particles.size(), 0.0);
  wall_distance_.assign(particles.size(), far_from_walls);
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    const FrictionWall<Dim>& wall = walls[i];
    const bool is_beside_wall = wall.weight > 0.0;
    if (!is_beside_wall && !is_reached(flow.pairs(), particles.layer_viscosity, i)) return;
    // A rough wall counts as 0.03 k_s farther away (Aupoix & Spalart 2003).
    wall_distance_[i] =
        is_beside_wall ? wall.distance + 0.03 * wall.roughness : distance_by_neighbours(flow.pairs(), particles, i);
    viscosity_[i] = next_layer_viscosity(flow, wall, velocity_gradient[i], wall_distance_[i], dt, i);
  });
  swap_with(particles);
  flow.halo().exchange(particles.layer_viscosity, particles.wall_distance);
}

template <int Dim>
void BoundaryLayers<Dim>::stay(Flow<Dim>& flow) {
  swap_with(flow.state.particles);
}

template <int Dim>
void BoundaryLayers<Dim>::swap_with(Particles<Dim>& particles) {
  particles.layer_viscosity.swap(viscosity_);
  particles.wall_distance.swap(wall_distance_);
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_boundary_layers(const CaseSpec& /*spec*/, const Setup<Dim>& setup,
                                                const Boundary<Dim>& boundary) {
  const bool has_friction =
      std::ranges::any_of(boundary.walls, [](const WallProperties& wall) { return wall.friction > 0.0; });
  if (!setup.formulation.has_eddy_viscosity || !has_friction || setup.has_implicit_viscosity) return nullptr;
  return std::make_unique<BoundaryLayers<Dim>>();
}

template class BoundaryLayers<2>;
template class BoundaryLayers<3>;
TAILWATER_IN_2D_AND_3D(make_boundary_layers);

}  // namespace tailwater
