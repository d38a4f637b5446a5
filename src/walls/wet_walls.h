// Which wall particles have water in reach, and the velocity of that water.
#pragma once

#include <cstdint>
#include <span>

#include "closures/fluid_pairs.h"

namespace tailwater {

/// Fills `fluid_weight` [1/m^Dim] (sum of W over fluid neighbours; 0 for fluid particles) and `is_wet` for walls.
template <int Dim>
void find_wet_walls(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double W_0,
                    std::span<double> fluid_weight, std::span<std::uint8_t> is_wet);

/// Shepard mean sum_f W u_f / sum_f W of the fluid in reach of wet wall particle i, whose sum of W is `fluid_weight`.
template <int Dim>
Vec<Dim> fluid_velocity_at_wall(const Pairs<Dim>& pairs, std::size_t i, double fluid_weight,
                                std::span<const Four> velocity) {
  VecLanes<Dim> sum{};
  for_each_pair(pairs, i, [&](const auto& several) { sum += several.kernel_of_fluid() * several.of(velocity); });
  return sum_of(sum) / fluid_weight;
}

}  // namespace tailwater
