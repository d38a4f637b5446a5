// What a run asks of any scheme.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Finds the pressure at the start, for the first measurements and as the guess of the first step. Nothing moves.
template <int Dim>
void start(Flow<Dim>& flow);

/// Takes a step in the order of the formulation. Advances the time and the number of the step.
template <int Dim>
StepReport advance(Flow<Dim>& flow, double dt);

}  // namespace tailwater
