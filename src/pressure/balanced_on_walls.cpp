#include "pressure/balanced_on_walls.h"

#include <cstdint>

#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "geometry/images.h"
#include "motion/wall_motion.h"
#include "neighbours/cell_grid.h"
#include "walls/patches.h"

namespace tailwater {
namespace {

/// dx; water in front of a patch is not farther from its centre than this.
constexpr double reach_in_front = 1.5;

/// dx; from the centre of a patch into the space in front, so that its own wall does not hide the water there.
constexpr double margin_of_eye = 0.1;

/// Sets q to 0 on walls that are not wet everywhere below its level. Bodies are (flow/balanced_pressure.h). Collective.
template <int Dim>
void keep_wet_walls(const Flow<Dim>& flow, std::vector<double>& q) {
  const Boundary<Dim>& boundary = flow.walls.boundary;
  const std::vector<WallPatch<Dim>>& patches = flow.walls.patches->all;
  const double spacing = flow.setup.scale.spacing;
  const double reach = reach_in_front * spacing;
  const std::vector<std::size_t> deep = indices_where(q.size(), [&](std::size_t k) { return q[k] > 0.0; });
  std::vector<Vec<Dim>> centres(deep.size());
  for_each(deep.size(), [&](std::size_t n) { centres[n] = patches[deep[n]].centre(boundary); });
  Box<Dim> around;
  for (const Vec<Dim>& centre : centres) around.extend(centre);
  around.widen(reach);
  const CellGrid<Dim> grid(centres, reach);
  std::vector<double> water_in_front(deep.size(), 0.0);
  const auto wet_near = [&](const Vec<Dim>& x) {
    if (!around.contains(x)) return;
    grid.for_each_near(x, [&](std::int32_t n) {
      const Vec<Dim> offset = x - centres[n];
      const Vec<Dim>& normal = boundary.faces[patches[deep[n]].face].normal;
      if (offset.dot(normal) <= 0.0 || offset.squaredNorm() >= reach * reach || water_in_front[n] != 0.0) return;
      const Vec<Dim> eye = centres[n] + margin_of_eye * spacing * normal;
      if (!is_hidden<Dim>(boundary.screens, boundary.screens_near(eye, reach), eye, x)) water_in_front[n] = 1.0;
    });
  };
  const Particles<Dim>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several mark one patch
    if (!particles.is_fluid(i) || flow.pairs().sees_wall[i] == 0) continue;
    const Vec<Dim>& x = particles.position[i];
    wet_near(x);
    visit_images<Dim>(flow.setup.domain, Box<Dim>(x), around, [&](const Vec<Dim>& by) { wet_near(x + by); });
  }
  flow.setup.ranks.sum_of_each(water_in_front);
  std::vector<std::uint8_t> is_dry(boundary.walls.size(), 0);
  for (std::size_t n = 0; n < deep.size(); ++n) {
    if (water_in_front[n] == 0.0) is_dry[boundary.faces[patches[deep[n]].face].wall] = 1;
  }
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    if (moving.body >= 0) is_dry[moving.wall] = 0;
  }
  for (const std::size_t k : deep) {
    if (is_dry[boundary.faces[patches[k].face].wall] != 0) q[k] = 0.0;
  }
}

}  // namespace

template <int Dim>
std::vector<double> balanced_on_walls(const Flow<Dim>& flow) {
  const BalancedPressure<Dim> balanced(flow);
  if (flow.walls.patches == nullptr || balanced.is_linear()) return {};
  const std::vector<WallPatch<Dim>>& patches = flow.walls.patches->all;
  std::vector<double> q(patches.size());
  for_each(q.size(), [&](std::size_t k) { q[k] = balanced.at(patches[k].centre(flow.walls.boundary)); });
  keep_wet_walls(flow, q);
  return q;
}

template <int Dim>
std::vector<bool> walls_with_balanced(const Flow<Dim>& flow) {
  const std::vector<double>& balanced = flow.walls.forces.balanced;
  std::vector<bool> walls(flow.walls.boundary.walls.size(), false);
  for (std::size_t k = 0; k < balanced.size(); ++k) {
    if (balanced[k] > 0.0) walls[flow.walls.boundary.faces[flow.walls.patches->all[k].face].wall] = true;
  }
  return walls;
}

TAILWATER_IN_2D_AND_3D(balanced_on_walls);
TAILWATER_IN_2D_AND_3D(walls_with_balanced);

}  // namespace tailwater
