// Where a wall curves away from the water, the first row of particles may separate from it by a part of dx. The gap is
// no surface: no air can enter there, and water that flows around the wall has to be drawn to it. A row without
// neighbours behind it looks like one at a surface, where there is no tension. Beside such a wall, water is therefore
// treated as being as far inside as the water in front of it (docs/theory/closures.md).
#pragma once

#include <span>

#include "walls/wall_model.h"

namespace tailwater {

/// Raises `interior` (free_surface.h) of owned fluid beside a wall that turns away from it to the mean of that of the
/// water straight in front: in full up to dx from the wall, not at all from 1.5 dx on. Continuous in the positions.
/// `interior` must be up to date on ghosts, which are not raised.
template <int Dim>
void see_water_in_front(const WallScene<Dim>& scene, double spacing, std::span<double> interior);

}  // namespace tailwater
