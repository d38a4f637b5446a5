// Patches of all walls of a flow, for forces that are integrals over walls.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/wall_patches.h"
#include "walls/walls.h"
#include "walls/wetted_patches.h"

namespace tailwater {

template <int Dim>
struct PatchesOfWalls {
  std::vector<WallPatch<Dim>> all;  ///< of all faces
  std::vector<std::int32_t> row;    ///< of each patch on a wall that moves, the nearest row of the table; else -1
  WettedPatches<Dim> wetted;        ///< at the present places of the walls
};

template <int Dim>
std::shared_ptr<PatchesOfWalls<Dim>> divide_into_patches(const CaseSpec& spec, const Walls<Dim>& walls);

/// Sets `wetted` to the present places of walls that move.
template <int Dim>
void place_patches(const Walls<Dim>& walls, PatchesOfWalls<Dim>& patches);

}  // namespace tailwater
