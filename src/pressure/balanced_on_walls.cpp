#include "pressure/balanced_on_walls.h"

#include <cstdint>
#include <span>
#include <utility>

#include "base/for_each.h"
#include "flow/balanced_pressure.h"
#include "motion/wall_motion.h"
#include "pressure/wet_patches.h"
#include "walls/patches.h"

namespace tailwater {
namespace {

/// dx; less deep below the level q is small, and waves leave patches dry.
constexpr double least_depth = 1.0;

/// Patches of which less is wet do not decide whether a wall is dry: where walls lie on each other, the borders of
/// their patches differ, and parts of covered patches are left.
constexpr double least_wet_share = 0.5;

/// Sets q to 0 on dry patches with more than `least` [Pa] of it, and on fixed walls with such patches that are not
/// behind other walls. Collective.
template <int Dim>
void keep_wet_patches(const Flow<Dim>& flow, double least, std::vector<double>& q) {
  const Boundary<Dim>& boundary = flow.walls.boundary;
  const std::span<const WallPatch<Dim>> patches = flow.walls.patches->all();
  const WettedPatches<Dim>& wetted = flow.walls.patches->wetted();
  const std::vector<std::size_t> deep = indices_where(q.size(), [&](std::size_t k) { return q[k] > least; });
  std::vector<PatchInReach<Dim>> in_reach;
  for (const std::size_t k : deep) {
    const auto patch = static_cast<std::int32_t>(k);
    in_reach.push_back({.face = patches[k].face,
                        .centre = wetted.centres()[k],
                        .may_be_hidden = wetted.may_be_hidden(patch),
                        .is_left_over = wetted.share(patch) < least_wet_share});
  }
  const WetPatches<Dim> wet(flow, std::move(in_reach));
  std::vector<std::uint8_t> is_dry(boundary.walls.size(), 0);
  for (std::size_t n = 0; n < deep.size(); ++n) {
    if (wet.is_wet(n)) continue;
    q[deep[n]] = 0.0;
    if (!wetted.may_be_hidden(static_cast<std::int32_t>(deep[n])))
      is_dry[boundary.faces[patches[deep[n]].face].wall] = 1;
  }
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    if (moving.body >= 0) is_dry[moving.wall] = 0;
  }
  for_each(q.size(), [&](std::size_t k) {
    if (is_dry[boundary.faces[patches[k].face].wall] != 0) q[k] = 0.0;
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
  keep_wet_patches(flow, balanced.below_level(least_depth * flow.setup.scale.spacing), q);
  return q;
}

template <int Dim>
std::vector<bool> walls_with_balanced(const Flow<Dim>& flow) {
  const std::vector<double>& balanced = flow.walls.forces.balanced;
  if (balanced.empty()) return std::vector<bool>(flow.walls.boundary.walls.size(), false);
  return flow.walls.patches->walls_with(flow.walls.boundary, balanced);
}

TAILWATER_IN_2D_AND_3D(balanced_on_walls);
TAILWATER_IN_2D_AND_3D(walls_with_balanced);

}  // namespace tailwater
