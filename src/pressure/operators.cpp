#include "pressure/operators.h"

#include <cmath>

#include "base/for_each.h"
#include "flow/stages.h"

namespace tailwater {

template <int Dim>
std::vector<Vec<Dim>> reactions_of_walls(const Flow<Dim>& flow, std::span<const std::size_t> walls,
                                         const std::vector<double>& pressure) {
  std::vector<Vec<Dim>> pushes(walls.size());
  flow.discretisation().wall_reactions(flow, walls, pressure, pushes);
  return pushes;
}

template <int Dim>
std::vector<double> find_divergence(Flow<Dim>& flow) {
  Particles<Dim>& particles = flow.state.particles;
  set_wall_velocities<Dim>(flow, flow.state.wall_velocity, particles.velocity);
  std::vector<double> divergence(particles.owned, 0.0);
  if (flow.pores == nullptr) {
    flow.discretisation().find_divergence(flow, particles.velocity, divergence);
  } else {
    flow.discretisation().find_divergence(flow, flow.filter_velocity(), divergence);
  }
  return divergence;
}

template <int Dim>
double bulk_rms(const Flow<Dim>& flow, const std::vector<double>& field) {
  const Vec<2> nothing = Vec<2>::Zero();
  Vec<2> squares_and_count = sum_over(field.size(), nothing, [&](std::size_t i) {
    const double weight = flow.setup.weight_in_statistics(flow.state.particles.volume[i]);
    return flow.is_inside(i) ? Vec<2>(weight * (field[i] * field[i]), weight) : nothing;
  });
  flow.setup.ranks.sum_each(squares_and_count[0], squares_and_count[1]);
  return squares_and_count[1] > 0.0 ? std::sqrt(squares_and_count[0] / squares_and_count[1]) : 0.0;
}

TAILWATER_IN_2D_AND_3D(reactions_of_walls);
TAILWATER_IN_2D_AND_3D(find_divergence);
TAILWATER_IN_2D_AND_3D(bulk_rms);

}  // namespace tailwater
