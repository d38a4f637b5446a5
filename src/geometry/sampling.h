// From shapes to particles: the fluid's starting lattice and the particles that stand for the walls.
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
  std::vector<int> wall;  ///< index into Boundary::walls

  std::size_t size() const { return position.size(); }
};

/// Three (or `layers`) rows of dummy particles behind each wall, the first at dx/2, rows following the wall's shape
/// and joined at mitred corners; on axis-parallel walls of whole length in dx they continue the fluid's lattice.
template <int Dim>
WallParticles<Dim> make_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers);

/// One row of particles on the wall itself (F36-F39), spaced dx, corners included.
template <int Dim>
WallParticles<Dim> make_surface_particles(const Boundary<Dim>& boundary, double spacing);

template <int Dim>
struct FluidParticles {
  std::vector<Vec<Dim>> position;
  std::vector<Vec<Dim>> velocity;
  std::vector<int> block;  ///< index into CaseSpec::fluid
};

/// The starting lattice. With dummy walls it is cell-centred (first particle dx/2 from the block's edge), with
/// pressure rows on the wall it is node-centred (particles on the block's edge, except where a wall particle stands).
/// Jitter, if any, is drawn from `particles.seed` and is the same on every machine.
template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
