// Patches of all walls of a flow, for forces that are integrals over walls. Their edges are at most
// `longest_patch_edge` of the spacing of the particles there, with walls and zones of refinement as drawn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/wall_patches.h"
#include "walls/walls.h"
#include "walls/wetted_patches.h"

namespace tailwater {

/// `boundary` is as drawn.
template <int Dim>
std::vector<WallPatch<Dim>> divide_into_patches(const CaseSpec& spec, const Boundary<Dim>& boundary);

template <int Dim>
class PatchesOfWalls {
 public:
  /// `walls` are as drawn.
  PatchesOfWalls(const CaseSpec& spec, const Walls<Dim>& walls);

  /// Sets `wetted` to the places of the walls, if these have moved since the last call.
  void place(const Boundary<Dim>& boundary);

  std::span<const WallPatch<Dim>> all() const { return all_; }
  const WettedPatches<Dim>& wetted() const { return wetted_; }
  /// By wall, whether one of its patches has a value above 0; none has without values.
  std::vector<bool> walls_with(const Boundary<Dim>& boundary, const std::vector<double>& values) const;
  /// The row of the table of walls nearest to a patch on a wall that moves; -1 for others.
  std::int32_t row(std::size_t patch) const { return row_[patch]; }
  /// The number of times that the walls have moved.
  std::size_t moves() const { return moves_; }

 private:
  PatchesOfWalls(const CaseSpec& spec, const Walls<Dim>& walls, const FractionAt<Dim>& spacing_at);

  std::vector<WallPatch<Dim>> all_;
  WettedPatches<Dim> wetted_;
  std::vector<std::int32_t> row_;
  std::vector<Vec<Dim>> moving_corners_;  ///< of the faces of walls that move, where they were placed
  std::size_t moves_ = 0;
};

}  // namespace tailwater
