// Reads the triangles of STL, OBJ and PLY files.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "base/vec.h"

namespace tailwater {

struct MeshTriangles {
  std::vector<Vec<3>> points;                 ///< m
  std::vector<std::array<int, 3>> triangles;  ///< indices into `points`, counter-clockwise as their front sees them
};

/// The triangles of a file, in its order. Throws InputError, which names the file and the remedy, for a file of another
/// kind, one that is empty or cut off, and for a coordinate that is not a number.
MeshTriangles read_mesh(const std::filesystem::path& path);

}  // namespace tailwater
