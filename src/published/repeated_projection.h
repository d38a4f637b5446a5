// The implicit order of a step of Farzin et al. (2014).
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Implicit projection, repeated form, as published (F20)-(F27): repeats the whole step until the derivatives are those
/// at the new positions.
template <int Dim>
StepReport repeated_projection_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
