#include "air/contact_lines.h"

#include <cstdint>
#include <limits>
#include <optional>

#include "base/for_each.h"
#include "neighbours/neighbourhood.h"
#include "pressure/operators.h"

namespace tailwater {
namespace {

/// 1/m; push of a wall particle along its wall by a uniform pressure of 1 Pa in the walls in front of its face, as if
/// these were water. With it only the air is missing in front of the face. None where another wall stands on the face:
/// no water touches it there, and the space behind that wall is missing as well.
template <int Dim>
std::optional<Vec<Dim>> push_of_walls_in_front(const Flow<Dim>& flow, std::size_t i, const NearestWall<Dim>& wall) {
  const Particles<Dim>& particles = flow.state.particles;
  const Vec<Dim>& x = particles.position[i];
  const double relative = flow.setup.relative_spacing(x);
  const double radius = kernel_radius(flow.setup.scale.kernel) * relative;
  const WallFace<Dim>& face = flow.walls.boundary.faces[wall.face];
  Vec<Dim> sum = Vec<Dim>::Zero();
  double nearest = std::numeric_limits<double>::infinity();  // m; of particles in front, from the place on the face
  bool is_covered = false;
  flow.neighbourhood->grid().for_each_near(flow.neighbourhood->wrapped(x), [&](std::int32_t k) {
    const auto other = static_cast<std::size_t>(k);
    if (other == i || face.height(particles.position[other]) <= 0.0) return;
    const bool is_wall = !particles.is_fluid(other);
    if (const double away = (particles.position[other] - wall.point).norm(); away < nearest) {
      nearest = away;
      is_covered = is_wall;
    }
    if (!is_wall) return;
    if (flow.walls.boundary.walls[flow.walls.particles.wall[particles.wall_row[other]]].is_plate) return;
    const Vec<Dim> d = x - particles.position[other];
    const double r = d.norm();
    if (r >= radius) return;
    const double F =
        kernel_steepness(flow.setup.scale.kernel, r / relative) / (power<Dim>(relative) * relative * relative);
    sum -= 2.0 * particles.volume[other] * F * d;
  });
  if (is_covered) return {};
  return sum;
}

}  // namespace

template <int Dim>
void remove_push_along_walls(Flow<Dim>& flow, const PocketStep<Dim>& step) {
  if (!flow.walls.forces.pressure_is_requested || step.pressure.empty()) return;
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> share(particles.size(), 0.0);     // fraction of pockets in the air beside water
  std::vector<double> pressure(particles.size(), 0.0);  // times that fraction
  for (const PocketSide<Dim>& side : step.water) {
    if (!side.is_beside) continue;
    for (const PocketShare& each : side.shares) share[side.particle] += each.share;
    pressure[side.particle] = step.pressure_at(side);
  }
  flow.halo().exchange(share);
  flow.halo().exchange(pressure);
  std::vector<std::size_t> walls;
  std::vector<double> beside;                          // Pa; of the air beside the water in front of each
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: lists
    if (particles.is_fluid(i)) continue;
    double sum = 0.0;
    double weight = 0.0;
    for (std::size_t k = flow.pairs().begin(i); k < flow.pairs().end(i); ++k) {
      sum += pressure[flow.pairs().j[k]];
      weight += share[flow.pairs().j[k]];
    }
    if (weight == 0.0) continue;
    walls.push_back(i);
    beside.push_back(sum / weight);
  }
  const std::vector<Vec<Dim>> pushes = reactions_of_walls<Dim>(flow, walls, std::vector<double>(particles.size(), 1.0));
  for_each(walls.size(), [&](std::size_t n) {
    const std::size_t i = walls[n];
    const double radius = kernel_radius(flow.setup.scale.kernel) * flow.setup.relative_spacing(particles.position[i]);
    const NearestWall<Dim> wall = flow.walls.boundary.nearest(particles.position[i], 2.0 * radius);
    if (wall.face < 0) return;
    const WallFace<Dim>& face = flow.walls.boundary.faces[wall.face];
    const std::optional<Vec<Dim>> of_walls = push_of_walls_in_front(flow, i, wall);
    if (!of_walls) return;
    const Vec<Dim> beside_air = pushes[n] + *of_walls;
    const Vec<Dim> along = beside_air - face.normal.dot(beside_air) * face.normal;
    flow.walls.forces.pressure[i] += (1.0 - share_of_water) * particles.volume[i] * beside[n] * along;
  });
}

TAILWATER_IN_2D_AND_3D(remove_push_along_walls);

}  // namespace tailwater
