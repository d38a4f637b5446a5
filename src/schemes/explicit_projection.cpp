#include "flow/stages.h"
#include "schemes/first_step.h"
#include "schemes/project.h"
#include "schemes/projection.h"

namespace tailwater {

template <int Dim>
StepReport explicit_projection_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  const auto missing = find_missing_inertia(flow, start, dt);
  StepReport report = project(flow, start, dt);  // (F14)-(F16)
  if (missing) add_missing_inertia(*missing, flow);
  const auto divergence_old = divergence_to_report(flow);          // (F18): the remainder at the old positions
  report.interventions.stopped_at_walls += move(flow, start, dt);  // (F17)
  report.interventions += shift(flow, dt);                         // (F28)-(F32)
  locate(flow);
  report.divergence = report_of_divergence(flow, divergence_old);
  return report;
}

TAILWATER_IN_2D_AND_3D(explicit_projection_step);

}  // namespace tailwater
