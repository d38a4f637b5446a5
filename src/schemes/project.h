// Parts that several steps share.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// (F14)-(F16), with all derivatives at the old positions. The particles do not move.
template <int Dim>
StepReport project(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Reports the divergence at the present positions, and its change since `divergence_old` (owned, 1/s), which the solve
/// left at the positions where it was posed.
template <int Dim>
void report_divergence(Flow<Dim>& flow, const std::vector<double>& divergence_old, StepReport& report);

}  // namespace tailwater
