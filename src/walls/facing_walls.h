// Point of action of the force between a wall particle and a water particle, for probes of the force on one wall of
// several. Half of the force acts through each particle, so that it acts midway between them, which is on the wall.
// Near a corner or an edge, the full force through one particle would assign a force of first order in dx to the wrong
// wall (docs/theory/probes.md). In a gap between two walls that do not meet, forces through a water particle could not
// be assigned to one wall. There the full force acts through the wall particles.
#pragma once

#include <cstddef>

#include "walls/wall_model.h"

namespace tailwater {

/// Fraction of the force of a pair with this row that acts through the water particle: 1/2, or 0 in a narrow gap. The
/// gap is one where, within two supports of the given `radius` [m], there is a wall of another direction (60 degrees)
/// that does not meet the row's wall in a corner.
template <int Dim>
double share_of_water(const Walls<Dim>& walls, std::size_t row, double radius);

}  // namespace tailwater
