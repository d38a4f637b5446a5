// What steps have in common.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// (F14)-(F16): all derivatives at the old positions, where the particles stay.
template <int Dim>
StepReport project(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Reports the divergence at the present positions, and what the move made of `divergence_old` (owned, 1/s), which the
/// solve left at its own.
template <int Dim>
void report_divergence(Flow<Dim>& flow, const std::vector<double>& divergence_old, StepReport& report);

}  // namespace tailwater
