// Walls that cross, as a bed and the frame around it, beyond which the bed continues.
#pragma once

#include "geometry/boundary.h"

namespace tailwater {

/// Whether two walls cross near `x`: a piece of one wall passes through a piece of the other, and each ends farther
/// than a tolerance from the other. Walls that only touch do not cross, as the two slopes of a dyke at its crest.
/// `distance` [m] is that of `x` from the farther wall. The line in which they cross is at most 1/sin(15 deg) times as
/// far, unless they are almost parallel. False for plates, which have no space behind them, and for ducts.
template <int Dim>
bool cross_near(const Boundary<Dim>& boundary, int a, int b, const Vec<Dim>& x, double distance);

}  // namespace tailwater
