// The pressure of the first moment, by the order of a step that comes next. Nothing has moved in the end.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// As the first projection of a step of dt finds it.
template <int Dim>
void project_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// As the two-step scheme finds it, at the positions predicted for dt.
template <int Dim>
void predict_pressure_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
