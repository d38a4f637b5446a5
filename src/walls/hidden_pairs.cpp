#include "walls/hidden_pairs.h"

#include <algorithm>
#include <limits>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// Visibility from water of the wall particle of a row that stands at `x`.
template <int Dim>
int felt_through(const Walls<Dim>& walls, std::int32_t row, const Vec<Dim>& x) {
  const Boundary<Dim>& boundary = walls.boundary;
  const int wall = walls.particles.wall[row];
  if (boundary.plate_of(wall) >= 0) return wall;
  const bool is_beyond_end = walls.particles.is_beyond_end[row] != 0;
  if (!boundary.is_beside_free_end(wall, x)) return is_beyond_end ? never_felt : felt_past_plates;
  // Another part of the wall may be as near to the end, as the top of a wall with thickness whose underside ends there.
  const NearestWall<Dim> nearest = boundary.nearest(x, std::numeric_limits<double>::infinity());
  const bool is_screened = std::ranges::any_of(boundary.screens_near(nearest.point, 0.0), [&](int s) {
    const Screen<Dim>& screen = boundary.screens[s];
    return screen.wall == wall && !screen.is_beyond && screen.front == nearest.face;
  });
  return is_beyond_end || is_screened ? wall : felt_past_plates;
}

}  // namespace

template <int Dim>
std::vector<int> find_felt_through(const Walls<Dim>& walls, const Particles<Dim>& particles) {
  if (walls.boundary.screens.empty() && walls.boundary.ends.empty()) return {};
  std::vector<int> felt(particles.size(), felt_past_screens);
  for_each(particles.size(), [&](std::size_t i) {
    if (!particles.is_fluid(i)) felt[i] = felt_through(walls, particles.wall_row[i], particles.position[i]);
  });
  return felt;
}

template <int Dim>
void hide_pairs_behind_screens(const Walls<Dim>& walls, const Particles<Dim>& particles,
                               Neighbourhood<Dim>& neighbourhood) {
  const std::vector<Screen<Dim>>& screens = walls.boundary.screens;
  const double radius = kernel_radius(neighbourhood.kernel());
  const Pairs<Dim>& pairs = neighbourhood.pairs();
  std::vector<int> felt;  // found when the first pair near a screen is
  std::vector<int> near;
  const auto may_change = [&](std::size_t i) {
    near.clear();
    if (!walls.boundary.has_screens_near(particles.position[i])) return false;
    for (const int s : walls.boundary.screens_near(particles.position[i], radius)) {
      if (screens[s].distance(particles.position[i]) < radius) near.push_back(s);
    }
    // Wall particles that act through a screen may be nearer than the screen.
    return !near.empty() || pairs.sees_wall[i] != 0 || !particles.is_fluid(i);
  };
  neighbourhood.weigh_pairs(may_change, [&](std::size_t i, std::size_t k) {
    if (felt.empty()) felt = find_felt_through(walls, particles);
    const auto j = static_cast<std::size_t>(pairs.j[k]);
    // In an order that both rows of the pair agree about.
    const bool is_forward = particles.id[i] < particles.id[j];
    const Vec<Dim>& from = particles.position[is_forward ? i : j];
    const Vec<Dim>& to = particles.position[is_forward ? j : i];
    const bool is_wall = felt[i] != felt_past_screens;
    const int wall = is_wall ? felt[i] : felt[j];
    return static_cast<float>(visible_fraction<Dim>(screens, near, from, to, wall, is_wall == is_forward));
  });
}

TAILWATER_IN_2D_AND_3D(find_felt_through);
TAILWATER_IN_2D_AND_3D(hide_pairs_behind_screens);

}  // namespace tailwater
