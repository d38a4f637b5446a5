#include "pressure/full_water.h"

#include <algorithm>
#include <limits>

#include "base/for_each.h"

namespace tailwater {

template <int Dim>
void take_out_mean(const Flow<Dim>& flow, double fullness, std::vector<double>& source) {
  if (fullness == 0.0) return;
  const Particles<Dim>& particles = flow.state.particles;
  const Vec<2> nothing = Vec<2>::Zero();
  Vec<2> sums = sum_over(source.size(), nothing, [&](std::size_t i) {
    return flow.role[i] == Role::water ? Vec<2>(particles.volume[i] * source[i], particles.volume[i]) : nothing;
  });
  flow.setup.ranks.sum_each(sums[0], sums[1]);
  if (sums[1] == 0.0) return;
  const double mean = sums[0] / sums[1];
  for_each(source.size(), [&](std::size_t i) {
    if (flow.role[i] == Role::water) source[i] -= fullness * mean;
  });
}

template <int Dim>
void shift_minimum_to_zero(const Flow<Dim>& flow, double fullness, std::span<const double> rest,
                           std::span<double> part) {
  if (fullness == 0.0) return;
  const std::size_t owned = flow.state.particles.owned;
  constexpr double none = std::numeric_limits<double>::lowest();
  const double least = -flow.setup.ranks.largest(largest_over(owned, none, [&](std::size_t i) {
    return flow.surroundings.takes_part[i] ? -part[i] - (rest.empty() ? 0.0 : rest[i]) : none;
  }));
  for_each(owned, [&](std::size_t i) {
    if (flow.surroundings.takes_part[i]) part[i] -= fullness * least;
  });
}

TAILWATER_IN_2D_AND_3D(take_out_mean);
TAILWATER_IN_2D_AND_3D(shift_minimum_to_zero);

}  // namespace tailwater
