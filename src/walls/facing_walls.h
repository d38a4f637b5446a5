// Walls that face each other across a narrow gap, for probes of the force on one wall of several. Half of the force
// between a wall particle and a water particle acts through each of them, so that it acts midway between them, which is
// on the wall. Near a corner or an edge, the full force through one particle would assign a force of first order in dx
// to the wrong wall (docs/theory/probes.md). In a gap between two walls that do not meet, a water particle receives the
// forces of both walls across the gap, which cannot be divided between them. There the force along the wall's normal
// acts through the wall particle alone. The force along the wall is divided in halves everywhere: where its division
// changed along a wall, a force of first order in dx along the wall would be left over.
#pragma once

#include <cstddef>

#include "walls/wall_model.h"

namespace tailwater {

/// Unit normal of the row's wall in a narrow gap, else 0. The gap is one where, within two supports of the given
/// `radius` [m], there is a wall of another direction (60 degrees) that does not meet the row's wall in a corner.
template <int Dim>
Vec<Dim> normal_in_gap(const Walls<Dim>& walls, std::size_t row, double radius);

}  // namespace tailwater
