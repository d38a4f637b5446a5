// One step of scheme F. Its implicit form as published is published/repeated_projection.h.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Explicit projection (F14)-(F17): div u' = 0 holds at the old positions (F18), or midway.
template <int Dim>
StepReport explicit_projection_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Implicit projection, residual form: the velocity at the end of the step is divergence-free at the new positions
/// (F19). The explicit step comes first. A second projection then removes the divergence that the first projection and
/// the move left at the new positions. Where the first one aims midway (`target_divergence`) the velocity is
/// divergence-free at both ends of the step and at mid-step, when it moves the particles: symmetric in time, like
/// RATTLE (Andersen 1983).
template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
