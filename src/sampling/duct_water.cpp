#include "sampling/duct_water.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel/at_start.h"

namespace tailwater {
namespace {

constexpr double near_water = 0.75;  // dx; a place so near to a particle is in the water

/// The water of all ranks before a mouth, up to a `depth` [m].
template <int Dim>
std::vector<WaterParticle<Dim>> water_before(const Opening<Dim>& mouth, double depth,
                                             const FluidParticles<Dim>& fluid) {
  const double tolerance = corner_tolerance * depth;
  std::vector<WaterParticle<Dim>> water;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<Dim>& x = fluid.position[i];
    const double beyond = mouth.beyond(x);
    if (beyond > tolerance || beyond <= tolerance - depth || !mouth.spans(x)) continue;
    water.push_back({x, fluid.velocity[i], fluid.volume[i], fluid.block[i]});
  }
  return gather_on_all(fluid.ranks, water);
}

/// One column of particles before a mouth that leans, and so is across the lattice of the water: one in each of its
/// cells beside which there is water, which has the velocity.
template <int Dim>
std::vector<WaterParticle<Dim>> column_before(const Opening<Dim>& mouth, double spacing,
                                              const std::vector<WaterParticle<Dim>>& water) {
  std::array<int, Dim - 1> count;
  std::size_t cells = 1;
  double volume = spacing;
  for (int axis = 0; axis < Dim - 1; ++axis) {
    const double length = mouth.edges[axis].norm();
    count[axis] = std::max(1, static_cast<int>(std::lround(length / spacing)));
    cells *= static_cast<std::size_t>(count[axis]);
    volume *= length / count[axis];
  }
  std::vector<WaterParticle<Dim>> column;
  for (std::size_t cell = 0; cell < cells && !water.empty(); ++cell) {
    Vec<Dim> x = mouth.corner - 0.5 * spacing * mouth.normal;
    std::size_t rest = cell;
    for (int axis = 0; axis < Dim - 1; ++axis) {
      const auto along = static_cast<std::size_t>(count[axis]);
      x += (static_cast<double>(rest % along) + 0.5) / count[axis] * mouth.edges[axis];
      rest /= along;
    }
    if (!mouth.spans(x)) continue;
    const auto nearest = std::ranges::min_element(
        water, {}, [&](const WaterParticle<Dim>& particle) { return (particle.position - x).squaredNorm(); });
    if ((nearest->position - x).norm() > near_water * spacing) continue;
    column.push_back({x, nearest->velocity, volume, nearest->block});
  }
  return column;
}

/// The particles that stand before a mouth, in a depth of one spacing.
template <int Dim>
std::vector<WaterParticle<Dim>> last_column(const Opening<Dim>& mouth, double spacing,
                                            const FluidParticles<Dim>& fluid) {
  const bool is_axis_parallel = mouth.normal.cwiseAbs().maxCoeff() > 1.0 - 1e-9;
  if (is_axis_parallel) return water_before(mouth, spacing, fluid);
  return column_before(mouth, spacing, water_before(mouth, 2.0 * spacing, fluid));
}

}  // namespace

template <int Dim>
std::vector<WaterParticle<Dim>> water_in_ducts(const std::vector<Duct<Dim>>& ducts, double spacing,
                                               const FluidParticles<Dim>& fluid) {
  std::vector<WaterParticle<Dim>> copies;
  for (const Duct<Dim>& duct : ducts) {
    for (const WaterParticle<Dim>& last : last_column(duct.mouth, spacing, fluid)) {
      WaterParticle<Dim> copy = last;
      const double room = duct.length - corner_tolerance * spacing - duct.mouth.beyond(last.position);
      for (int k = 1; k * spacing < room; ++k) {
        copy.position = last.position + k * spacing * duct.mouth.normal;
        copies.push_back(copy);
      }
    }
  }
  return copies;
}

template <int Dim>
void append_water(const std::vector<WaterParticle<Dim>>& water, std::int64_t others, FluidParticles<Dim>& fluid) {
  const std::int64_t before = fluid.all;
  const auto count = static_cast<std::int64_t>(water.size());
  const std::int64_t all = before + others;  // of fluid and walls that move; `others` are the water and these
  const auto number_of_first = [&](int rank) {
    return std::clamp(all * rank / fluid.ranks.size() - before, std::int64_t{0}, count);
  };
  const std::int64_t begin = number_of_first(fluid.ranks.rank());
  const std::int64_t end = number_of_first(fluid.ranks.rank() + 1);
  if (fluid.position.empty()) fluid.first = before + begin;
  for (std::int64_t n = begin; n < end; ++n) {
    const WaterParticle<Dim>& particle = water[static_cast<std::size_t>(n)];
    fluid.position.push_back(particle.position);
    fluid.velocity.push_back(particle.velocity);
    fluid.volume.push_back(particle.volume);
    fluid.block.push_back(particle.block);
    if (!fluid.id.empty()) fluid.id.push_back(before + n);
  }
  fluid.all += count;
}

TAILWATER_IN_2D_AND_3D(water_in_ducts);
TAILWATER_IN_2D_AND_3D(append_water);

}  // namespace tailwater
