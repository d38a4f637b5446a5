#include <algorithm>
#include <span>

#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "motion/wall_motion.h"
#include "pressure/balanced_on_walls.h"
#include "pressure/operators.h"
#include "pressure/stages.h"
#include "walls/facing_walls.h"

namespace tailwater {
namespace {

/// The normal of each wall particle's wall in a narrow gap, ghosts included; 0 elsewhere, at fluid and at dry walls.
template <int Dim>
std::vector<Vec<Dim>> normals_in_gaps(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const bool rests = flow.setup.wall_motion->moving().empty();
  std::vector<Vec<Dim>> normals(particles.size(), Vec<Dim>::Zero());
  for_each(particles.size(), [&](std::size_t i) {
    if (particles.is_fluid(i) || !flow.surroundings.is_wet[i]) return;
    const auto row = static_cast<std::size_t>(particles.wall_row[i]);
    const double radius = kernel_radius(flow.setup.scale.kernel) * flow.setup.relative_spacing(particles.position[i]);
    normals[i] = rests ? flow.walls.normal_in_gap[row] : normal_in_gap(flow.walls, row, radius);
  });
  return normals;
}

/// Adds the forces that act through these water particles, by pairs that count with `share`. Calls add(force, f) with
/// the sum for a particle and its force f.
template <int Dim, class Add>
void add_through_water(Flow<Dim>& flow, std::span<const std::size_t> water, std::span<const double> share,
                       const std::vector<double>& pressure, std::vector<Vec<Dim>>& forces, Add&& add) {
  std::vector<Vec<Dim>> pushes(water.size());
  flow.discretisation().reactions_seen_by_water(flow, water, share, pressure, pushes);
  for_each(water.size(),
           [&](std::size_t n) { add(forces[water[n]], Vec<Dim>(flow.state.particles.volume[water[n]] * pushes[n])); });
}

/// Takes from these water particles the forces along the normals n of walls in gaps: n n^T f of each pair, entry by
/// entry of n n^T. `whole`: the fraction with which the forces of pairs were added.
template <int Dim>
void take_forces_across_gaps(Flow<Dim>& flow, std::span<const std::size_t> water, const std::vector<double>& whole,
                             const std::vector<Vec<Dim>>& normals, const std::vector<double>& pressure,
                             std::vector<Vec<Dim>>& forces) {
  std::vector<double> share(normals.size());
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b <= a; ++b) {
      for_each(share.size(), [&](std::size_t i) { share[i] = whole[i] * normals[i][a] * normals[i][b]; });
      if (std::ranges::none_of(share, [](double one) { return one != 0.0; })) continue;
      add_through_water(flow, water, share, pressure, forces, [&](Vec<Dim>& sum, const Vec<Dim>& force) {
        sum[a] -= force[b];
        if (b < a) sum[b] -= force[a];
      });
    }
  }
}

/// Adds the forces of the pairs of a pressure field, by wall particle and by water particle.
template <int Dim>
void add_forces_of_pairs(Flow<Dim>& flow, const std::vector<double>& pressure, std::vector<Vec<Dim>>& by_wall,
                         std::vector<Vec<Dim>>& by_water) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<Vec<Dim>> normals = normals_in_gaps(flow);
  std::vector<double> share(particles.size(), 0.0);
  std::vector<std::size_t> walls;
  std::vector<std::size_t> water;
  for (std::size_t i = 0; i < particles.size(); ++i) {  // in order: lists
    if (!particles.is_fluid(i) && flow.surroundings.is_wet[i]) share[i] = share_of_water;
    if (i >= particles.owned) continue;
    if (!particles.is_fluid(i)) {
      walls.push_back(i);
    } else if (flow.pairs().sees_wall[i] != 0) {
      water.push_back(i);
    }
  }
  const std::vector<Vec<Dim>> pushes = reactions_of_walls<Dim>(flow, walls, pressure);
  for_each(walls.size(), [&](std::size_t n) {
    const std::size_t i = walls[n];
    const Vec<Dim> across = normals[i].dot(pushes[n]) * normals[i];
    by_wall[i] -= particles.volume[i] * ((1.0 - share[i]) * pushes[n] + share_of_water * across);
  });
  add_through_water(flow, water, share, pressure, by_water, [](Vec<Dim>& sum, const Vec<Dim>& force) { sum += force; });
  take_forces_across_gaps(flow, water, share, normals, pressure, by_water);
}

}  // namespace

template <int Dim>
void add_wall_forces(Flow<Dim>& flow, const std::vector<double>& pressure) {
  WallForces<Dim>& forces = flow.walls.forces;
  if (forces.pressure_is_requested) add_forces_of_pairs(flow, pressure, forces.pressure, forces.through_water);
}

template <int Dim>
void find_wall_forces(Flow<Dim>& flow) {
  const std::vector<double>& pressure = flow.state.particles.pressure;
  WallForces<Dim>& forces = flow.walls.forces;
  forces.balanced = balanced_on_walls(flow);
  const std::vector<bool> is_integrated = walls_with_balanced(flow);
  const auto integrated = std::ranges::count(is_integrated, true);
  if (integrated == 0 || !forces.pressure_is_requested) return add_wall_forces(flow, pressure);
  const std::vector<double> q = balanced_pressure(flow, pressure);
  std::vector<double> rest(q.size());
  for_each(rest.size(), [&](std::size_t i) { rest[i] = pressure[i] - q[i]; });
  add_wall_forces(flow, rest);
  if (integrated == std::ssize(is_integrated)) return;
  forces.of_balanced.assign(forces.pressure.size(), Vec<Dim>::Zero());
  add_forces_of_pairs(flow, q, forces.of_balanced, forces.of_balanced);
}

TAILWATER_IN_2D_AND_3D(add_wall_forces);
TAILWATER_IN_2D_AND_3D(find_wall_forces);

}  // namespace tailwater
