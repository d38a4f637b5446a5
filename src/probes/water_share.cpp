#include "probes/water_share.h"

namespace tailwater {
namespace {

template <int Dim>
bool is_wall(const ProbeContext<Dim>& context, std::int32_t j) {
  return !context.particles.is_fluid(j);
}

/// Particles j with is_water(j) count as water, unless they are of a liquid that is not measured; all others are wall.
template <int Dim, class IsWater>
double share(const ProbeContext<Dim>& context, const Vec<Dim>& x, IsWater&& is_water) {
  double water = 0.0;
  double wall = 0.0;
  for_each_weight(context, x, [&](std::int32_t j, double weight) {
    if (!is_wall(context, j) && !context.is_measured(j)) return;  // as air
    (is_water(j) ? water : wall) += weight;
  });
  return water_share<Dim>(water, wall);
}

}  // namespace

template <int Dim>
double water_share(const ProbeContext<Dim>& context, const Vec<Dim>& x) {
  return share(context, x, [&](std::int32_t j) { return !is_wall(context, j); });
}

template <int Dim>
double water_share_above_wet_bed(const ProbeContext<Dim>& context, const Vec<Dim>& x, const Vec<Dim>& bed,
                                 const Vec<Dim>& bed_normal) {
  return share(context, x, [&](std::int32_t j) {
    return !is_wall(context, j) || bed_normal.dot(context.particles.position[j] - bed) < 0.0;
  });
}

template double water_share<2>(const ProbeContext<2>&, const Vec<2>&);
template double water_share<3>(const ProbeContext<3>&, const Vec<3>&);
TAILWATER_IN_2D_AND_3D(water_share_above_wet_bed);

}  // namespace tailwater
