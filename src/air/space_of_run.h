// The space in which a run searches for air.
#pragma once

#include "base/box.h"
#include "case/spec.h"
#include "flow/flow.h"

namespace tailwater {

/// Box around walls, wherever they go, and openings. Its lowest corner is a whole number of cells from that of the
/// walls as drawn, so that cells lie where they would in a run with another end.
template <int Dim>
Box<Dim> box_of_run(const CaseSpec& spec, const Setup<Dim>& setup, const Boundary<Dim>& boundary);

}  // namespace tailwater
