// The fluid's starting lattice.
#pragma once

#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/wall_particles.h"

namespace tailwater {

template <int Dim>
struct FluidParticles {
  std::vector<Vec<Dim>> position;
  std::vector<Vec<Dim>> velocity;
  std::vector<int> block;  ///< index into CaseSpec::fluid
};

/// The starting lattice, from each block's low corner with exactly dx between particles. With dummy walls it is
/// cell-centred: the first particle is dx/2 from the block's edge. With a row of particles on the wall it is
/// node-centred, except in periodic directions: particles stand on the block's edge, but not nearer than dx/2 to a
/// wall, where a wall particle stands. A box holds extent/dx particles per direction, rounded, at least one; if
/// node-centred, one more. A polygon holds the lattice points of its bounding box that lie inside, and every second one
/// of those on its outline, because half of their cells is inside. For polygons, and beside slanted walls, particles
/// nearer than dx/4 to a wall are moved to that distance, which keeps the volume. check_geometry reports everything
/// else that fits badly.
/// Jitter, if any, is drawn from `particles.seed` and is the same on every machine.
/// Throws InputError, which names the block, for a block without extent or with coordinates of the wrong dimension.
template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
