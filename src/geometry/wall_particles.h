// The particles that stand for the walls.
#pragma once

#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// Particles that stand for the walls; they never move relative to their wall.
template <int Dim>
struct WallParticles {
  std::vector<Vec<Dim>> position;
  /// Unit normal of the wall into the fluid; at a corner the normalised mean of the adjacent normals.
  std::vector<Vec<Dim>> normal;
  /// Symmetric projector on the directions the wall blocks, with eigenvalues in [0, 1]: n n^T at a flat wall, I at a
  /// right-angled corner, in between a continuous blend: the eigenvalues of the sum of n n^T over the adjacent
  /// normals, clipped at 1. A free-slip mirror image of velocity u is u - 2 M u.
  std::vector<Mat<Dim>> blocked;
  std::vector<int> wall;    ///< index into Boundary::walls
  std::size_t on_wall = 0;  ///< the first so many stand on the wall itself, the others behind it

  std::size_t size() const { return position.size(); }
  bool is_on_wall(std::int32_t row) const { return static_cast<std::size_t>(row) < on_wall; }
};

/// Layers of dummy particles that fill the kernel's support behind a wall; with a row on the wall, that row included.
int dummy_layers(const CaseSpec& spec);

/// `layers` rows of dummy particles behind each wall, the first at dx/2, rows following the wall's shape and joined at
/// mitred corners; on axis-parallel walls of whole length in dx they continue the fluid's lattice. Faces join where
/// they share a corner and agree on the side of the fluid, whichever wall they belong to. None lies nearer than dx/2 to
/// another, behind a second wall, or farther than 1.5 layers dx from its wall. In 3D: box walls only; nothing stands
/// above an open face. Walls of one body know nothing of another: when they part nothing is missing, and nothing
/// overlaps as long as the bodies do not.
template <int Dim>
WallParticles<Dim> make_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers);

/// One row of particles on the wall itself (F36-F39), spaced dx, with its ends and all corners sharper than 30 degrees.
template <int Dim>
WallParticles<Dim> make_surface_particles(const Boundary<Dim>& boundary, double spacing);

/// The same row on the wall and `layers` - 1 rows of dummies behind it, dx apart: on axis-parallel walls of whole
/// length in dx one lattice.
template <int Dim>
WallParticles<Dim> make_row_and_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers);

}  // namespace tailwater
