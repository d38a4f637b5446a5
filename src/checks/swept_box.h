// Where a wall that moves is during a run.
#pragma once

#include "base/box.h"
#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// The box around a wall at a hundred instants of the run.
template <int Dim>
Box<Dim> swept_box(const CaseSpec& spec, const Boundary<Dim>& drawn, int wall);

}  // namespace tailwater
