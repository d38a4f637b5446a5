// Where a wall that moves is during a run.
#pragma once

#include <vector>

#include "base/box.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "motion/affine_map.h"

namespace tailwater {

/// Number of times in a run, after its start, at which the path of a wall or zone is evaluated.
inline constexpr int looks_at_path = 100;

/// The motion of a wall from where it is drawn, at these instants. A wall of a floating body stays.
template <int Dim>
std::vector<AffineMap<Dim>> path_of_wall(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall);

/// The box around a wall at these instants.
template <int Dim>
Box<Dim> swept_box(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall);

}  // namespace tailwater
