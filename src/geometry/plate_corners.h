// Corners in which two plates end (geometry/screen.h).
#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "geometry/rim_ends.h"

namespace tailwater {

/// The number of the corner that an end of a plate makes with the end of one other plate; -1: it makes none. Where more
/// plates meet, no line passes several of them from one side to the same side.
template <int Dim>
int corner_number(const Boundary<Dim>& boundary, const WallPlate& plate, int end, const Lengths& lengths);

/// Makes a corner part of the screens of a plate near it, and adds the screen beyond it.
template <int Dim>
void add_corner(const ScreenCorner<Dim>& corner, Screen<Dim> beyond, const Lengths& lengths,
                std::vector<Screen<Dim>>& screens);

}  // namespace tailwater
