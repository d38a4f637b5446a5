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

/// dx; from the centre of a patch that has no particle near it to that of another one which shows that it is wet: in a
/// film of water between two walls, or in a sharp corner of one.
constexpr double reach_of_wet = 2.0;

/// dx; from the centre of a patch into the space in front, so that its own wall does not hide the water there.
constexpr double margin_of_eye = 0.1;

/// dx; less deep below the level q is small, and waves leave patches dry.
constexpr double least_depth = 1.0;

/// Patches of which less is wet do not decide whether a wall is dry: where walls lie on each other, the borders of
/// their patches differ, and parts of covered patches are left.
constexpr double least_wet_share = 0.5;

/// Patches below the level of q that are not covered by other walls.
template <int Dim>
struct DeepPatches {
  /// Those with more than `least` [Pa] of `q`.
  DeepPatches(const Flow<Dim>& flow, const std::vector<double>& q, double least)
      : boundary(flow.walls.boundary),
        patches(flow.walls.patches->all()),
        index(indices_where(q.size(), [&](std::size_t k) { return q[k] > least; })) {
    for (const std::size_t k : index) {
      centres.push_back(flow.walls.patches->wetted().centres()[k]);
      spacing.push_back(flow.setup.scale.spacing * flow.setup.relative_spacing(centres.back()));
    }
    grid = CellGrid<Dim>(centres, reach_of_wet * flow.setup.scale.spacing);
  }

  const WallFace<Dim>& face(std::size_t n) const { return boundary.faces[patches[index[n]].face]; }

  const Boundary<Dim>& boundary;
  std::span<const WallPatch<Dim>> patches;
  std::vector<std::size_t> index;
  std::vector<Vec<Dim>> centres;
  std::vector<double> spacing;  ///< m; of the particles there
  CellGrid<Dim> grid;           ///< of the centres
};

/// 0 for patches without water in front of them. Collective.
template <int Dim>
std::vector<double> find_water_in_front(const Flow<Dim>& flow, const DeepPatches<Dim>& deep) {
  Box<Dim> around;
  for (const Vec<Dim>& centre : deep.centres) around.extend(centre);
  around.widen(reach_in_front * flow.setup.scale.spacing);
  std::vector<double> water_in_front(deep.index.size(), 0.0);
  const auto wet_near = [&](const Vec<Dim>& x) {
    if (!around.contains(x)) return;
    deep.grid.for_each_near(x, [&](std::int32_t n) {
      const Vec<Dim> offset = x - deep.centres[n];
      const double reach = reach_in_front * deep.spacing[n];
      const Vec<Dim>& normal = deep.face(n).normal;
      if (offset.dot(normal) <= 0.0 || offset.squaredNorm() >= reach * reach || water_in_front[n] != 0.0) return;
      const Vec<Dim> eye = deep.centres[n] + margin_of_eye * deep.spacing[n] * normal;
      if (!is_hidden<Dim>(deep.boundary.screens, deep.boundary.screens_near(eye, reach), eye, x)) {
        water_in_front[n] = 1.0;
      }
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
  return water_in_front;
}

/// Whether a patch without water in front is wet all the same: another wall faces it across a film, or a patch near it,
/// on the same side of the same wall, has water in front.
template <int Dim>
bool is_wet_without_particle(const DeepPatches<Dim>& deep, const std::vector<double>& water_in_front, std::size_t n) {
  const WallFace<Dim>& face = deep.face(n);
  const double reach = reach_of_wet * deep.spacing[n];
  bool found = false;
  deep.grid.for_each_near(deep.centres[n], [&](std::int32_t m) {
    const Vec<Dim> offset = deep.centres[m] - deep.centres[n];
    if (found || offset.squaredNorm() >= reach * reach) return;
    const double alike = deep.face(m).normal.dot(face.normal);
    found = deep.face(m).wall == face.wall ? alike > 0.0 && water_in_front[m] != 0.0
                                           : alike < 0.0 && offset.dot(face.normal) > 0.0;
  });
  return found;
}

/// Sets q to 0 on walls with dry patches among those with more than `least` [Pa] of it. Bodies are wet
/// (flow/balanced_pressure.h). Collective.
template <int Dim>
void keep_wet_walls(const Flow<Dim>& flow, double least, std::vector<double>& q) {
  const DeepPatches<Dim> deep(flow, q, least);
  const std::vector<double> water_in_front = find_water_in_front(flow, deep);
  std::vector<std::uint8_t> is_dry(deep.boundary.walls.size(), 0);
  for (std::size_t n = 0; n < deep.index.size(); ++n) {
    if (flow.walls.patches->wetted().share(static_cast<std::int32_t>(deep.index[n])) < least_wet_share) continue;
    const bool is_wet = water_in_front[n] != 0.0 || is_wet_without_particle(deep, water_in_front, n);
    if (!is_wet) is_dry[deep.face(n).wall] = 1;
  }
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    if (moving.body >= 0) is_dry[moving.wall] = 0;
  }
  for_each(q.size(), [&](std::size_t k) {
    if (is_dry[deep.boundary.faces[deep.patches[k].face].wall] != 0) q[k] = 0.0;
  });
}

}  // namespace

template <int Dim>
std::vector<double> balanced_on_walls(Flow<Dim>& flow) {
  const BalancedPressure<Dim> balanced(flow);
  if (flow.walls.patches == nullptr || balanced.is_linear()) return {};
  flow.walls.patches->place(flow.walls.boundary);
  const PatchesOfWalls<Dim>& patches = *flow.walls.patches;
  std::vector<double> q(patches.all().size());
  for_each(q.size(), [&](std::size_t k) {
    const Vec<Dim>& normal = flow.walls.boundary.faces[patches.all()[k].face].normal;
    const bool is_wet = patches.wetted().share(static_cast<std::int32_t>(k)) > 0.0;
    q[k] = is_wet ? balanced.on_wall(patches.wetted().centres()[k], normal) : 0.0;
  });
  keep_wet_walls(flow, balanced.below_level(least_depth * flow.setup.scale.spacing), q);
  return q;
}

template <int Dim>
std::vector<bool> walls_with_balanced(const Flow<Dim>& flow) {
  const std::vector<double>& balanced = flow.walls.forces.balanced;
  std::vector<bool> walls(flow.walls.boundary.walls.size(), false);
  for (std::size_t k = 0; k < balanced.size(); ++k) {
    if (balanced[k] > 0.0) walls[flow.walls.boundary.faces[flow.walls.patches->all()[k].face].wall] = true;
  }
  return walls;
}

TAILWATER_IN_2D_AND_3D(balanced_on_walls);
TAILWATER_IN_2D_AND_3D(walls_with_balanced);

}  // namespace tailwater
