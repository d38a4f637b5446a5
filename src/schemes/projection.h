// One step of scheme F by either time integrator.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Explicit projection (F14)-(F17): div u' = 0 holds at the old positions (F18), or midway.
template <int Dim>
StepReport explicit_projection_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Implicit projection, residual form: the velocity at the end of the step is divergence-free at the new positions
/// (F19). The explicit step, then a second projection of the velocity, of what the move and the first projection left
/// at the new positions. With `divergence_free = "midway"` the velocity is divergence-free at both ends of the step and
/// halfway, when it moves the particles: symmetric in time, as RATTLE (Andersen 1983) is.
template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Implicit projection, repeated form, as published (F20)-(F27): the whole step again until the derivatives are those
/// at the new positions.
template <int Dim>
StepReport repeated_projection_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
