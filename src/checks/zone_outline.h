// The outline of a zone of finer particles in a picture.
#pragma once

#include <array>
#include <vector>

#include "checks/svg.h"
#include "refinement/spacing_field.h"

namespace tailwater {

/// Pieces of the line [m] in the plane of the picture around all places of a zone, which has a depth. In 3D a place is
/// in the zone if any place behind or before it, in `box`, is.
template <int Dim>
std::vector<std::array<Vec<2>, 2>> outline_of_zone(const SpacingField<Dim>& field,
                                                   const typename SpacingField<Dim>::Zone& zone, const Box<Dim>& box,
                                                   const View& view);

}  // namespace tailwater
