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
  std::vector<double> volume;  ///< m^Dim
  std::vector<int> block;      ///< index into CaseSpec::fluid
};

/// The cells of a block's lattice along each axis. A box has cells between its ends and the planes of axis-parallel
/// walls that reach into it, a fill between those of all walls and its level, a polygon has cells of exactly dx from
/// its lowest corner. Throws InputError as make_fluid_particles does.
template <int Dim>
Lattice<Dim> make_lattice(const CaseSpec& spec, std::size_t block, const Boundary<Dim>& boundary);

/// The starting lattice. With dummy walls a particle is the centre of its cell and has the cell's volume. With a row of
/// particles on the wall particles stand at the cells' corners, except in periodic directions, but not nearer than dx/2
/// to a wall, where a wall particle stands. Places in bodies with the water outside hold no particle. A polygon holds
/// the lattice points of its bounding box that lie inside, and every second one of those on its outline, because half
/// of their cells is inside. For polygons, and beside slanted walls, particles nearer than dx/4 to a wall are moved to
/// that distance, which keeps the volume. check_geometry reports everything else that fits badly. Jitter, if any, is
/// drawn from `particles.seed` and is the same on every machine. Throws InputError, which names the block, for a block
/// without extent or with coordinates of the wrong dimension, and for a fill as filled_cells does.
template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
