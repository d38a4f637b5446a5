// Which wall particles have water in reach, and the velocity of that water.
#pragma once

#include <cstdint>
#include <span>

#include "base/for_each.h"
#include "closures/fluid_pairs.h"
#include "walls/wall_model.h"

namespace tailwater {

/// Fills `fluid_weight` [1/m^Dim] (sum of W over fluid neighbours; 0 for fluid particles) and `is_wet` for walls.
template <int Dim>
void find_wet_walls(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double W_0,
                    std::span<double> fluid_weight, std::span<std::uint8_t> is_wet);

/// Shepard mean sum_f W u_f / sum_f W of the fluid in reach of wet wall particle i, whose sum of W is `fluid_weight`.
template <int Dim>
Vec<Dim> fluid_velocity_at_wall(const Pairs<Dim>& pairs, std::size_t i, double fluid_weight,
                                std::span<const Float4> velocity) {
  VecLanes<Dim> sum{};
  for_each_pair(pairs, i, [&](const auto& batch) { sum += batch.kernel_of_fluid() * batch.of(velocity); });
  return sum_of(sum) / fluid_weight;
}

/// The plane at which wet wall particle i mirrors the water.
template <int Dim>
struct Mirror {
  Vec<Dim> normal;
  Mat<Dim> blocked;  ///< directions that are reversed
};

/// The mirror of a particle's wall. Beside a convex edge it faces the mean place of the water in reach, as far as the
/// normals of the walls that meet there allow. A wall without water in front of it blocks nothing.
template <int Dim>
Mirror<Dim> mirror_at(const WallScene<Dim>& scene, std::size_t i);

/// Sets the entries of owned wall particles in `velocity` (WallModel::show_velocity): of wet ones to
/// shown(row, V, tangential, normal), of the wall's own velocity and the parts of the water's mean relative to it; of
/// dry ones to 0.
template <int Dim, class Shown>
void show_water(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V, std::span<Vec<Dim>> velocity, Shown&& shown) {
  const std::vector<Float4> of_water = as_float4<Dim>(velocity);
  for_each(scene.pairs.owned(), [&](std::size_t i) {
    if (scene.particles.is_fluid(i)) return;
    velocity[i].setZero();
    if (!scene.surroundings.is_wet[i]) return;
    const Vec<Dim> mean =
        fluid_velocity_at_wall<Dim>(scene.pairs, i, scene.surroundings.wall_fluid_weight[i], of_water);
    const auto row = scene.particles.wall_row[i];
    const Vec<Dim> own = entry_of<Dim>(V, row);
    const Vec<Dim> relative = mean - own;
    const Vec<Dim> normal_part = mirror_at(scene, i).blocked * relative;
    const Vec<Dim> tangential_part = relative - normal_part;
    velocity[i] = shown(row, own, tangential_part, normal_part);
  });
}

}  // namespace tailwater
