// The particles that represent the walls.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "refinement/spacing_field.h"
#include "sampling/lattice_axis.h"
#include "sampling/space_share.h"

namespace tailwater {

/// Particles that represent the walls. They never move relative to their wall.
template <int Dim>
struct WallParticles {
  std::vector<Vec<Dim>> position;
  /// Unit normal of the wall into the fluid; at a corner the normalised mean of the adjacent normals.
  std::vector<Vec<Dim>> normal;
  /// Symmetric projector M onto the directions that the wall blocks: the sum of n n^T over the adjacent normals, with
  /// its eigenvalues clipped at 1. It is n n^T at a flat wall, I at a right-angled corner, and changes continuously in
  /// between. The free-slip mirror image of the velocity u is u - 2 M u.
  std::vector<Mat<Dim>> blocked;
  /// Columns: normals of the walls beyond convex edges in reach, nearest first; 0 where there are none.
  std::vector<Mat<Dim>> beyond_edges;
  std::vector<double> share;                ///< volume over dx^Dim
  std::vector<int> wall;                    ///< index into Boundary::walls
  std::vector<std::uint8_t> is_beyond_end;  ///< 1: beyond a free end of its wall, acts through the wall's screens only
  /// Number of its place among all proposed places: unique, whichever part of space is sampled. The numbers of
  /// particles on the wall itself come first.
  std::vector<std::int64_t> number;
  std::int64_t numbers = 0;          ///< upper limit of all numbers, exclusive
  std::int64_t numbers_on_wall = 0;  ///< upper limit of the numbers of particles on the wall itself, exclusive

  std::size_t size() const { return position.size(); }
  bool is_on_wall(std::int32_t row) const { return number[row] < numbers_on_wall; }

  /// Calls body with references to the entries of the particles.
  template <class Body>
  void apply_to_fields(Body&& body) {
    body(position, normal, blocked, beyond_edges, share, wall, is_beyond_end, number);
  }
  template <class Body>
  void apply_to_fields(Body&& body) const {
    body(position, normal, blocked, beyond_edges, share, wall, is_beyond_end, number);
  }
};

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
/// until their volumes are nearest to that of the local spacing at the wall. Away from borders only `layers` rows of
/// them remain. On flat walls the rows are the same as those of that spacing. Meshes are sampled again on finer
/// lattices, whose cells divide those of the case.
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
