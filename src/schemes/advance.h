// What a run asks of a scheme, whichever the case chose.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Finds the pressure at the start, so that the first measurements show it and the first step starts from it. Nothing
/// moves.
template <int Dim>
void start(Flow<Dim>& flow);

/// A step by the scheme and integrator that the case chose; advances the time and the number of the step.
template <int Dim>
StepReport advance(Flow<Dim>& flow, double dt);

}  // namespace tailwater
