// Reads the triangles of STL, OBJ and PLY files.
#pragma once

#include <filesystem>
#include <string>

#include "geometry/triangle_mesh.h"

namespace tailwater {

/// The triangles of a file, in its order. Throws InputError, which
/// begins with the `owner` ("wall 'pier'") and names the file and the remedy, for a file of another kind, one that is
/// empty or cut off, and for a coordinate that is not a number.
TriangleMesh read_mesh(const std::filesystem::path& path, const std::string& owner);

}  // namespace tailwater
