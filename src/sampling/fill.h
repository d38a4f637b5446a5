// Which cells of the lattice water fills that is poured in at a point.
#pragma once

#include <string>

#include "case/spec.h"
#include "geometry/boundary.h"
#include "sampling/cell_set.h"
#include "sampling/lattice_axis.h"

namespace tailwater {

/// The cells of a `fill` that the water reaches from its seed without passing a wall or an open end, up to the cells
/// below its level. Throws CaseError if the seed is in a wall,
/// above the level or too near to a wall, or if the water runs out of the case.
template <int Dim>
CellSet<Dim> filled_cells(const CaseSpec& spec, const FluidTable& block, const CaseLabel& owner,
                          const Boundary<Dim>& boundary, const Lattice<Dim>& lattice);

}  // namespace tailwater
