// Reads the triangles of STL, OBJ and PLY files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// bytes; five million triangles of binary STL, far more than the sampling of walls can handle
inline constexpr std::uintmax_t largest_mesh_file = std::uintmax_t{1} << 28;

struct MeshTriangles {
  std::vector<Vec<3>> points;                 ///< m
  std::vector<std::array<int, 3>> triangles;  ///< indices into `points`, counter-clockwise as seen from the front
};

/// The triangles of a file, in its order. Throws InputError, which names the file and the remedy, for a file of another
/// kind, and for one that is empty, truncated, damaged or too large. A coordinate that is not a number is an InputError
/// too. Throws IoError for a folder, a device or a pipe.
MeshTriangles read_mesh(const std::filesystem::path& path);

}  // namespace tailwater
