// Where a wall that moves is during a run.
#pragma once

#include <vector>

#include "base/box.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "motion/affine_map.h"

namespace tailwater {

/// The motion of a wall from where it is drawn, at a hundred instants of the run. A wall of a floating body stays.
template <int Dim>
std::vector<AffineMap<Dim>> path_of_wall(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall);

/// The box around a wall at these instants.
template <int Dim>
Box<Dim> swept_box(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall);

}  // namespace tailwater
