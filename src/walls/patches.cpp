#include "walls/patches.h"

#include <limits>
#include <span>

#include "base/for_each.h"
#include "geometry/from_spec.h"
#include "geometry/outer_patches.h"
#include "neighbours/cell_grid.h"
#include "refinement/spacing_field.h"

namespace tailwater {
namespace {

/// dx; the first row is 0.5 behind its wall, and a patch has edges of up to `longest_patch_edge`.
constexpr double reach_of_rows = 2.0;

/// dx; no wall particle is farther than this from a patch, beside the 1.5 dx for each layer
/// (sampling/wall_particles.h).
constexpr double margin_of_reach = 1.0;

/// Empty without zones of refinement.
template <int Dim>
FractionAt<Dim> spacing_as_drawn(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  const SpacingField<Dim> field(spec, boundary);
  if (field.is_uniform()) return {};
  return [field](const Vec<Dim>& x) { return field.at_drawn(x); };
}

template <int Dim>
std::vector<WallPatch<Dim>> divide(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                   const FractionAt<Dim>& spacing_at) {
  return outer_patches(spec, boundary,
                       make_wall_patches<Dim>(boundary, longest_patch_edge * spec.particles.spacing, spacing_at));
}

template <int Dim>
std::vector<double> spacing_at_patches(const FractionAt<Dim>& spacing_at, const Boundary<Dim>& boundary,
                                       std::span<const WallPatch<Dim>> patches) {
  std::vector<double> spacing(patches.size(), 1.0);
  if (!spacing_at) return spacing;
  for_each(spacing.size(), [&](std::size_t k) { spacing[k] = spacing_at(patches[k].centre(boundary)); });
  return spacing;
}

template <int Dim>
std::vector<std::int32_t> nearest_rows(const Walls<Dim>& walls, std::span<const WallPatch<Dim>> patches,
                                       double spacing) {
  std::vector<std::int32_t> nearest(patches.size(), -1);
  const std::span<const Vec<Dim>> rows = std::span(walls.particles.position).first(walls.moving);
  const CellGrid<Dim> grid(rows, reach_of_rows * spacing);
  for_each(rows.empty() ? 0 : patches.size(), [&](std::size_t k) {
    const int wall = walls.boundary.faces[patches[k].face].wall;
    if (!walls.boundary.walls[wall].moves()) return;
    const Vec<Dim> centre = patches[k].centre(walls.boundary);
    double least = std::numeric_limits<double>::infinity();
    grid.for_each_near(centre, [&](std::int32_t row) {
      const double squared = (rows[row] - centre).squaredNorm();
      if (walls.particles.wall[row] != wall || squared >= least) return;
      least = squared;
      nearest[k] = row;
    });
  });
  return nearest;
}

template <int Dim>
std::vector<Vec<Dim>> corners_that_move(const Boundary<Dim>& boundary) {
  std::vector<Vec<Dim>> corners;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (boundary.walls[face.wall].moves()) corners.insert(corners.end(), face.corners.begin(), face.corners.end());
  }
  return corners;
}

}  // namespace

template <int Dim>
std::vector<WallPatch<Dim>> divide_into_patches(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  return divide(spec, boundary, spacing_as_drawn(spec, boundary));
}

template <int Dim>
PatchesOfWalls<Dim>::PatchesOfWalls(const CaseSpec& spec, const Walls<Dim>& walls)
    : PatchesOfWalls(spec, walls, spacing_as_drawn(spec, walls.boundary)) {}

template <int Dim>
PatchesOfWalls<Dim>::PatchesOfWalls(const CaseSpec& spec, const Walls<Dim>& walls, const FractionAt<Dim>& spacing_at)
    : all_(divide(spec, walls.boundary, spacing_at)),
      wetted_(spec, walls.boundary, spacing_at_patches<Dim>(spacing_at, walls.boundary, all_),
              (1.5 * dummy_layers(spec) + margin_of_reach) * spec.particles.spacing),
      row_(nearest_rows<Dim>(walls, all_, spec.particles.spacing)),
      moving_corners_(corners_that_move(walls.boundary)) {
  wetted_.place(walls.boundary, all_);
}

template <int Dim>
void PatchesOfWalls<Dim>::place(const Boundary<Dim>& boundary) {
  std::vector<Vec<Dim>> corners = corners_that_move(boundary);
  if (corners == moving_corners_) return;
  moving_corners_ = std::move(corners);
  ++moves_;
  wetted_.place(boundary, all_);
}

template <int Dim>
std::vector<bool> PatchesOfWalls<Dim>::walls_with(const Boundary<Dim>& boundary,
                                                  const std::vector<double>& values) const {
  std::vector<bool> walls(boundary.walls.size(), false);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (values[k] > 0.0) walls[boundary.faces[all_[k].face].wall] = true;
  }
  return walls;
}

template class PatchesOfWalls<2>;
template class PatchesOfWalls<3>;
TAILWATER_IN_2D_AND_3D(divide_into_patches);

}  // namespace tailwater
