// Stages that several steps share.
#pragma once

#include <optional>
#include <vector>

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// (F14)-(F16), with all derivatives at the old positions. The particles do not move.
template <int Dim>
StepReport project(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// The divergence (owned, 1/s) at the present positions, which are those of the last solve, if this step reports it:
/// every tenth step, since only the report needs it. Collective.
template <int Dim>
std::optional<std::vector<double>> divergence_to_report(Flow<Dim>& flow);

/// Reports `old`, if there is one, and the divergence at the present positions. Collective.
template <int Dim>
std::optional<DivergenceReport> report_of_divergence(Flow<Dim>& flow, const std::optional<std::vector<double>>& old);

}  // namespace tailwater
