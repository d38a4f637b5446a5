// Functions of every scheme that a run calls.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Computes the pressure at the start, for the first measurements and as the guess of the first step. Nothing moves.
template <int Dim>
void start(Flow<Dim>& flow);

/// Prepares all data of a step of dt that do not follow from the positions: walls, roles, open ends, wave makers, air,
/// bodies. Returns the state at the start of the step.
template <int Dim>
StepStart<Dim> begin_step(Flow<Dim>& flow, double dt);

/// Performs the step that has begun, in the order of the formulation. Advances the time and the step number.
template <int Dim>
StepReport advance(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Begins and performs a step.
template <int Dim>
StepReport advance(Flow<Dim>& flow, double dt) {
  return advance(flow, begin_step(flow, dt), dt);
}

}  // namespace tailwater
