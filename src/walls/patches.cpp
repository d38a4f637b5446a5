#include "walls/patches.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>

#include "base/for_each.h"
#include "neighbours/cell_grid.h"

namespace tailwater {
namespace {

/// dx; the first row is 0.5 behind its wall, and a patch has edges of up to `longest_patch_edge`.
constexpr double reach_of_rows = 2.0;

/// dx; half of the depth in another wall down to which a patch is known to be behind it.
constexpr double depth_of_covers = 6.0;

}  // namespace

template <int Dim>
std::shared_ptr<PatchesOfWalls<Dim>> divide_into_patches(const CaseSpec& spec, const Walls<Dim>& walls) {
  const double spacing = spec.particles.spacing;
  const auto patches = std::make_shared<PatchesOfWalls<Dim>>(
      PatchesOfWalls<Dim>{.all = make_wall_patches(walls.boundary, longest_patch_edge * spacing),
                          .row = {},
                          .wetted = {spec, walls.boundary, spacing, depth_of_covers * spacing}});
  patches->wetted.place(walls.boundary, patches->all);
  patches->row.assign(patches->all.size(), -1);
  const std::span<const Vec<Dim>> rows = std::span(walls.particles.position).first(walls.moving);
  const CellGrid<Dim> grid(rows, reach_of_rows * spacing);
  for_each(rows.empty() ? 0 : patches->all.size(), [&](std::size_t k) {
    const int wall = walls.boundary.faces[patches->all[k].face].wall;
    if (!walls.boundary.walls[wall].moves()) return;
    const Vec<Dim> centre = patches->all[k].centre(walls.boundary);
    double least = std::numeric_limits<double>::infinity();
    grid.for_each_near(centre, [&](std::int32_t row) {
      const double squared = (rows[row] - centre).squaredNorm();
      if (walls.particles.wall[row] != wall || squared >= least) return;
      least = squared;
      patches->row[k] = row;
    });
  });
  return patches;
}

template <int Dim>
void place_patches(const Walls<Dim>& walls, PatchesOfWalls<Dim>& patches) {
  const bool moves = std::ranges::any_of(walls.boundary.walls, &WallProperties::moves);
  if (moves) patches.wetted.place(walls.boundary, patches.all);
}

TAILWATER_IN_2D_AND_3D(divide_into_patches);
TAILWATER_IN_2D_AND_3D(place_patches);

}  // namespace tailwater
