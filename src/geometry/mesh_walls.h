// Walls from mesh files.
#pragma once

#include "base/box.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/triangle_mesh.h"

namespace tailwater {

/// The triangles of a file where they stand in the case, whether they can be a wall or not. Throws CaseError
/// for a file that read_mesh refuses.
TriangleMesh read_placed_mesh(const PlacedFile& file, const CaseLabel& owner);

/// The mesh of a wall's table where it stands in the case: scaled, turned, moved and welded, with its front towards the
/// water; that of a plate, which is open, with its front as drawn. Throws CaseError, which names the file,
/// triangles and places, for a file that read_mesh refuses, degenerate or double triangles,
/// edges of more than two, neighbours that face opposite sides, an open mesh that should be closed, a closed one that
/// should be open, and a mesh too far from the origin for the file's digits.
TriangleMesh make_wall_mesh(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner);

/// The closed mesh of a block of water or of a layer that water fills, its front outside, among walls that are in the
/// box `walls`. Throws CaseError as make_wall_mesh does, and for a mesh that the walls cannot hold.
TriangleMesh make_water_mesh(const CaseSpec& spec, const PlacedFile& file, const CaseLabel& owner, const Box<3>& walls);

/// Adds such a wall to the boundary.
void append_mesh(const CaseSpec& spec, const WallTable& table, int wall, const CaseLabel& owner, Boundary<3>& boundary);

/// Adds a plate from a mesh to the boundary.
void append_mesh_plate(const CaseSpec& spec, const WallTable& table, int wall, const CaseLabel& owner,
                       Boundary<3>& boundary);

}  // namespace tailwater
