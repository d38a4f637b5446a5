#include "walls/wet_walls.h"

#include "base/for_each.h"

namespace tailwater {
namespace {

/// A wall particle is wet when its kernel sum over the fluid exceeds this share of W(0): some fluid particle is inside
/// its support, not merely on the edge.
constexpr double least_wet_weight = 1e-6;

}  // namespace

template <int Dim>
void find_wet_walls(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double W_0,
                    std::span<double> fluid_weight, std::span<std::uint8_t> is_wet) {
  for_each(pairs.owned(), [&](std::size_t i) {
    fluid_weight[i] = 0.0;
    is_wet[i] = 0;
    if (particles.is_fluid(i)) return;
    LaneSum sum;
    for_each_pair(pairs, i, [&](const auto& several) { sum += several.kernel_of_fluid(); });
    fluid_weight[i] = sum.total();
    is_wet[i] = fluid_weight[i] > least_wet_weight * W_0;
  });
}

TAILWATER_IN_2D_AND_3D(find_wet_walls);

}  // namespace tailwater
