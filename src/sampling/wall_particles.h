// Makes the particles that represent the walls.
#pragma once

#include "geometry/boundary.h"
#include "refinement/spacing_field.h"
#include "sampling/lattice_axis.h"
#include "sampling/space_share.h"
#include "sampling/wall_table.h"

namespace tailwater {

/// `layers` rows of dummy particles behind each wall, the first at dx/2. Rows follow the wall's shape and join at
/// mitred corners. On axis-parallel walls with a length of a whole number of dx they continue the fluid's lattice.
/// Faces join where they share a corner and agree on the side of the fluid, even if they belong to different walls. No
/// particle is nearer than dx/2 to another, behind a second wall, or farther than 1.5 layers dx from its wall. In 3D:
/// boxes and meshes; there are no particles above an open face. Each body is sampled as if it were alone: when bodies
/// separate no particle is missing, and particles overlap only if their bodies do.
///
/// Makes all particles of moving walls, and those particles of walls at rest that are in `share`, a part of space.
/// Particles behind meshes stand on the nodes of the `lattice`, which should be that of the water
/// (lattice_behind_meshes).
template <int Dim>
WallParticles<Dim> make_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers,
                                        const SpaceShare& share = {}, const Lattice<Dim>& lattice = {});

/// Divides the particles of make_dummy_particles in zones of refinement, each into 2^Dim along and across its wall,
/// until their volumes are nearest to that of the local spacing at the wall, or of the finest one on walls at rest if
/// zones move. On flat walls the rows are the same as those of that spacing, and beside edges they have the normals of
/// those. Parts in front of their wall are left out. Away from borders of zones at rest, the `layers` rows of the local
/// spacing take their place. Meshes are sampled again on finer lattices, whose cells divide those of the case.
template <int Dim>
void divide_wall_particles(const SpacingField<Dim>& field, const Boundary<Dim>& boundary, double spacing, int layers,
                           const SpaceShare& share, const Lattice<Dim>& lattice, WallParticles<Dim>& particles);

/// One row of particles on the wall itself (F36-F39), dx apart, including its ends and all corners that turn by more
/// than 30 degrees.
template <int Dim>
WallParticles<Dim> make_surface_particles(const Boundary<Dim>& boundary, double spacing, const SpaceShare& share = {});

/// The row of make_surface_particles and `layers` - 1 rows of dummies behind it, dx apart. On axis-parallel walls with
/// a length of a whole number of dx they form one lattice.
template <int Dim>
WallParticles<Dim> make_row_and_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers,
                                                const SpaceShare& share = {});

}  // namespace tailwater
