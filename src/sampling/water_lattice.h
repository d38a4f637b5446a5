// The lattice of the water: its cells along each axis.
#pragma once

#include "case/spec.h"
#include "geometry/boundary.h"
#include "sampling/lattice_axis.h"

namespace tailwater {

/// The cells of a block's lattice along each axis. They divide a box between its ends and the planes of axis-parallel
/// walls that reach into it. They divide a fill between the planes of all walls and its level. In a polygon or mesh,
/// its own axis-parallel sides count as well. Throws InputError as make_fluid_particles does.
template <int Dim>
Lattice<Dim> make_lattice(const CaseSpec& spec, std::size_t block, const Boundary<Dim>& boundary);

/// The lattice of the first block, which continues behind walls from meshes: their particles stand on it. Empty if
/// there are no such walls, or no water.
template <int Dim>
Lattice<Dim> lattice_behind_meshes(const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
