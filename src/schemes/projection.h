// One step of scheme F by either time integrator.
#pragma once

#include "schemes/flow.h"

namespace tailwater {

/// (F14)-(F16): all derivatives at the old positions, where the particles stay.
template <int Dim>
StepReport project(Flow<Dim>& flow, double dt);

/// Explicit projection (F14)-(F17): div u' = 0 holds at the old positions (F18), or midway.
template <int Dim>
StepReport explicit_projection_step(Flow<Dim>& flow, double dt);

/// Implicit projection: the velocity at the end of the step is divergence-free at the new positions (F19).
///
/// Residual form: the explicit step, then a second projection of the velocity, of what the move and the first
/// projection left at the new positions. With `divergence_free = "midway"` the velocity is divergence-free at both ends
/// of the step and halfway, when it moves the particles: symmetric in time, as RATTLE (Andersen 1983) is. Repeated
/// form, as published (F20)-(F27): the whole step again until the derivatives are those at the new positions.
template <int Dim>
StepReport implicit_projection_step(Flow<Dim>& flow, double dt);

}  // namespace tailwater
