#include "base/for_each.h"
#include "motion/wall_motion.h"
#include "pressure/operators.h"
#include "pressure/stages.h"
#include "walls/facing_walls.h"

namespace tailwater {
namespace {

/// The fraction of a pair's force that acts through its fluid particle, by wall particle, ghosts included; 0 at fluid.
template <int Dim>
std::vector<double> shares_of_water(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const bool rests = flow.setup.wall_motion->moving().empty();
  std::vector<double> share(particles.size(), 0.0);
  for_each(particles.size(), [&](std::size_t i) {
    if (particles.is_fluid(i) || !flow.surroundings.is_wet[i]) return;
    const auto row = static_cast<std::size_t>(particles.wall_row[i]);
    const double radius = kernel_radius(flow.setup.scale.kernel) * flow.setup.relative_spacing(particles.position[i]);
    share[i] = rests ? flow.walls.share_of_water[row] : share_of_water(flow.walls, row, radius);
  });
  return share;
}

}  // namespace

template <int Dim>
void add_wall_forces(Flow<Dim>& flow, const std::vector<double>& pressure) {
  if (!flow.walls.forces.pressure_is_requested) return;
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<double> share = shares_of_water(flow);
  std::vector<std::size_t> walls;
  std::vector<std::size_t> water;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: lists
    if (!particles.is_fluid(i)) {
      walls.push_back(i);
    } else if (flow.pairs().sees_wall[i] != 0) {
      water.push_back(i);
    }
  }
  WallForces<Dim>& forces = flow.walls.forces;
  std::vector<Vec<Dim>> pushes = reactions_of_walls<Dim>(flow, walls, pressure);
  for_each(walls.size(), [&](std::size_t n) {
    const std::size_t i = walls[n];
    forces.pressure[i] -= (1.0 - share[i]) * particles.volume[i] * pushes[n];
  });
  pushes.resize(water.size());
  flow.discretisation().reactions_seen_by_water(flow, water, share, pressure, pushes);
  for_each(water.size(),
           [&](std::size_t n) { forces.through_water[water[n]] += particles.volume[water[n]] * pushes[n]; });
}

TAILWATER_IN_2D_AND_3D(add_wall_forces);

}  // namespace tailwater
