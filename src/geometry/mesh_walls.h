// Walls from mesh files.
#pragma once

#include <string>

#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/triangle_mesh.h"

namespace tailwater {

/// The triangles of a wall's file where they stand in the case, whether they can be a wall or not. Throws InputError
/// for a file that read_mesh refuses.
TriangleMesh read_placed_mesh(const WallTable& table, const std::string& owner);

/// The mesh of a wall's table where it stands in the case: scaled, turned, moved and welded, with its front towards the
/// water. Throws InputError, which names the wall (`owner`), the file, triangles and places, and the remedy, for a file
/// that read_mesh refuses, degenerate or double triangles, edges of more than two, neighbours that face opposite sides,
/// an open mesh that should be closed, and a mesh too far from the origin for the file's digits.
TriangleMesh make_wall_mesh(const CaseSpec& spec, const WallTable& table, const std::string& owner);

/// Adds such a wall to the boundary.
void append_mesh(const CaseSpec& spec, const WallTable& table, int wall, const std::string& owner,
                 Boundary<3>& boundary);

}  // namespace tailwater
