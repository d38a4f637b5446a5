// Parts of patches of walls that border on water. A hull is a closed wall that water surrounds. It may stand on another
// wall or in it, as a pile does in a bed. The part of its surface there then has no water, nor has the bed below the
// hull or inside it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "case/spec.h"
#include "geometry/wall_patches.h"
#include "neighbours/cell_grid.h"

namespace tailwater {

template <int Dim>
class WettedPatches {
 public:
  /// `spacing` [m] is the largest edge of patches over `longest_patch_edge`, and `reach` [m] that of the grid. Patches
  /// twice as far behind other walls may count as wet.
  WettedPatches(const CaseSpec& spec, const Boundary<Dim>& boundary, double spacing, double reach);

  /// Determines the parts at the present places of the faces.
  void place(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches);

  /// m; of the wet part of each patch, or of a dry patch.
  const std::vector<Vec<Dim>>& centres() const { return centres_; }
  /// Fraction of a patch that is in front of all other walls.
  double share(std::int32_t patch) const { return share_[patch]; }
  /// The centres by place.
  const CellGrid<Dim>& grid() const { return grid_; }

 private:
  /// Walls that a place may be behind: a hull, or all walls that are no hulls.
  struct Others {
    int hull;                         ///< index into Boundary::walls, or -1
    std::vector<std::uint8_t> walls;  ///< by wall, whether it belongs to them
    Box<Dim> box = {};                ///< around the hull
  };

  void find_part(const Boundary<Dim>& boundary, const WallPatch<Dim>& patch, std::size_t k);
  bool is_under_wall(const Boundary<Dim>& boundary, std::span<const WallPatch<Dim>> patches, std::size_t k) const;

  double spacing_;
  double reach_;
  std::vector<std::uint8_t> is_hull_;  ///< by wall
  std::vector<Others> others_;         ///< empty without hulls
  std::vector<Vec<Dim>> centres_;
  std::vector<double> share_;
  CellGrid<Dim> grid_;
};

}  // namespace tailwater
