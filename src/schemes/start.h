// The initial pressure, computed in the order of the first step. Afterwards all particles are where they were.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Computes it by the first projection of a step of length dt.
template <int Dim>
void project_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Computes it by the two-step scheme, at the positions predicted for dt.
template <int Dim>
void predict_pressure_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
