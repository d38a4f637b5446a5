#include "closures/wall_velocity.h"

#include "base/for_each.h"

namespace tailwater {
namespace {

/// A wall particle is wet when the fluid's kernel sum at it exceeds this share of W(0): some particle is inside its
/// support and not on its very edge.
constexpr double least_wet_weight = 1e-6;

}  // namespace

template <int Dim>
void find_wet_walls(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double W_0,
                    std::span<double> fluid_weight, std::span<std::uint8_t> is_wet) {
  for_each(pairs.owned(), [&](std::size_t i) {
    fluid_weight[i] = 0.0;
    is_wet[i] = 0;
    if (particles.is_fluid(i)) return;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      if (particles.is_fluid(pairs.j[k])) fluid_weight[i] += pairs.W[k];
    }
    is_wet[i] = fluid_weight[i] > least_wet_weight * W_0;
  });
}

template <int Dim>
void set_wall_velocity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, const WallModel<Dim>& walls,
                       std::span<const double> fluid_weight, std::span<const std::uint8_t> is_wet,
                       std::span<const Vec<Dim>> V, std::span<Vec<Dim>> mean, std::span<Vec<Dim>> velocity) {
  for_each(pairs.owned(), [&](std::size_t i) {
    if (particles.is_fluid(i)) return;
    mean[i].setZero();
    velocity[i].setZero();
    if (!is_wet[i]) return;
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      if (particles.is_fluid(pairs.j[k])) sum += pairs.W[k] * velocity[pairs.j[k]];
    }
    mean[i] = sum / fluid_weight[i];
    const auto row = particles.wall_row[i];
    const Vec<Dim> relative = mean[i] - V[row];
    const Vec<Dim> normal_part = walls.particles.blocked[row] * relative;
    const Vec<Dim> tangential_part = relative - normal_part;
    if (walls.treatment == WallTreatment::dummies) {
      velocity[i] = V[row] + tangential_part - normal_part;
    } else {
      velocity[i] = V[row] + (1.0 - walls.friction[row]) * tangential_part;
    }
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                       \
  template void find_wet_walls<Dim>(const Pairs<Dim>&, const Particles<Dim>&, double, std::span<double>, \
                                    std::span<std::uint8_t>);                                            \
  template void set_wall_velocity<Dim>(const Pairs<Dim>&, const Particles<Dim>&, const WallModel<Dim>&,  \
                                       std::span<const double>, std::span<const std::uint8_t>,           \
                                       std::span<const Vec<Dim>>, std::span<Vec<Dim>>, std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
