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
  /// Symmetric projector M onto the directions the wall blocks: the sum of n n^T over the adjacent normals, with its
  /// eigenvalues clipped at 1. It is n n^T at a flat wall, I at a right-angled corner, and changes continuously in
  /// between. A free-slip mirror image of velocity u is u - 2 M u.
  std::vector<Mat<Dim>> blocked;
  /// Columns: normals of the walls beyond convex edges in reach, the nearest first; 0 where there are none.
  std::vector<Mat<Dim>> beyond_edges;
  std::vector<double> share;                ///< its volume, over dx^Dim
  std::vector<int> wall;                    ///< index into Boundary::walls
  std::vector<std::uint8_t> is_beyond_end;  ///< 1: beyond a free end of its wall, felt through the wall's screens only
  /// Unique, whichever share of the walls was made: of its place among all that were looked at. Those of particles on
  /// the wall itself come first.
  std::vector<std::int64_t> number;
  std::int64_t numbers = 0;          ///< all numbers are below
  std::int64_t numbers_on_wall = 0;  ///< and below this those of particles on the wall itself

  std::size_t size() const { return position.size(); }
  bool is_on_wall(std::int32_t row) const { return number[row] < numbers_on_wall; }

  /// Calls body with references to the entries of the particles.
  template <class Body>
  void apply_to_fields(Body&& body) {
    body(position, normal, blocked, beyond_edges, share, wall, is_beyond_end, number);
  }
};

/// `layers` rows of dummy particles behind each wall, the first at dx/2. Rows follow the wall's shape and join at
/// mitred corners. On axis-parallel walls of a whole number of dx they continue the fluid's lattice. Faces join where
/// they share a corner and agree on the side of the fluid, even if they belong to different walls. No particle is
/// nearer than dx/2 to another, behind a second wall, or farther than 1.5 layers dx from its wall. In 3D: boxes and
/// meshes; nothing stands above an open face. Each body is sampled as if it were alone: when bodies separate nothing is
/// missing, and their particles overlap only if the bodies do.
///
/// Of walls at rest only the particles in `share` are made; those of the other shares are the rest. All of walls that
/// move are. Those behind meshes stand on the nodes of the `lattice`: give that of the water (lattice_behind_meshes).
template <int Dim>
WallParticles<Dim> make_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers,
                                        const SpaceShare& share = {}, const Lattice<Dim>& lattice = {});

/// Divides the particles behind walls at rest in zones of refinement, each into 2^Dim along and across its wall, until
/// their volumes are nearest to those that the field asks for at the wall. On flat walls the rows stand as those of
/// that spacing do.
template <int Dim>
void divide_wall_particles(const SpacingField<Dim>& field, const Boundary<Dim>& boundary, double spacing,
                           WallParticles<Dim>& particles);

/// One row of particles on the wall itself (F36-F39), spaced dx, with its ends and all corners sharper than 30 degrees.
template <int Dim>
WallParticles<Dim> make_surface_particles(const Boundary<Dim>& boundary, double spacing, const SpaceShare& share = {});

/// The same row on the wall and `layers` - 1 rows of dummies behind it, dx apart. On axis-parallel walls of a whole
/// number of dx they are one lattice.
template <int Dim>
WallParticles<Dim> make_row_and_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers,
                                                const SpaceShare& share = {});

}  // namespace tailwater
