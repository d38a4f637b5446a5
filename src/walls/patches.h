// Patches of all walls of a flow, for forces that are integrals over walls.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/wall_patches.h"
#include "walls/walls.h"

namespace tailwater {

template <int Dim>
struct PatchesOfWalls {
  std::vector<WallPatch<Dim>> all;  ///< of all faces
  std::vector<std::int32_t> row;    ///< of each patch on a wall that moves, the nearest row of the table; else -1
};

template <int Dim>
std::shared_ptr<const PatchesOfWalls<Dim>> divide_into_patches(const Walls<Dim>& walls, double spacing);

}  // namespace tailwater
