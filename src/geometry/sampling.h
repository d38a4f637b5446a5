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
/// cell-centred (first particle dx/2 from the block's edge), with a row of particles on the wall it is node-centred
/// (particles on the block's edge, except nearer than dx/2 to a wall, where a wall particle stands) but in periodic
/// directions. A box holds extent/dx particles per direction, rounded, at least one. A polygon holds the lattice points
/// of its bounding box that lie inside, and every second one of those on its outline: half of their cells is inside.
/// Along walls of polygons, and slanted walls, particles nearer than dx/4 to the wall are moved to that distance, which
/// keeps the volume; everything else that fits badly is left for check_geometry to report.
/// Jitter, if any, is drawn from `particles.seed` and is the same on every machine.
/// Throws InputError, naming the block, for one without extent or with coordinates of the wrong dimension.
template <int Dim>
FluidParticles<Dim> make_fluid_particles(const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
