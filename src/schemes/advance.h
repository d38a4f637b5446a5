// What a run asks of any scheme.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Finds the pressure at the start, for the first measurements and as the guess of the first step. Nothing moves.
template <int Dim>
void start(Flow<Dim>& flow);

/// Makes all that does not follow from the positions ready for a step of dt: walls, roles, open ends, wave makers, air,
/// bodies. Returns where the step starts.
template <int Dim>
StepStart<Dim> begin_step(Flow<Dim>& flow, double dt);

/// Takes the step that has begun, in the order of the formulation. Advances the time and the number of the step.
template <int Dim>
StepReport advance(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Both.
template <int Dim>
StepReport advance(Flow<Dim>& flow, double dt) {
  return advance(flow, begin_step(flow, dt), dt);
}

}  // namespace tailwater
