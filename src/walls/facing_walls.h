// Where the force between a wall particle and a water particle acts, for those who ask for the force on one wall of
// several: half of it through either, so that it acts in the middle of the two, which is on the wall. Near a corner or
// an edge all of it through one of them would put a force of first order in dx to the wrong wall
// (docs/theory/probes.md). Through a water particle in a gap between two walls that do not meet, the forces on both
// could not be told apart: there all of it acts through the wall particles.
#pragma once

#include <cstddef>

#include "walls/wall_model.h"

namespace tailwater {

/// The share of the force of a pair with this row that acts through the water particle: 1/2, or 0 where across less
/// water than two supports of the given `radius` [m] there is a wall of another direction (60 degrees) with which the
/// row's does not meet in a corner.
template <int Dim>
double share_of_water(const Walls<Dim>& walls, std::size_t row, double radius);

}  // namespace tailwater
