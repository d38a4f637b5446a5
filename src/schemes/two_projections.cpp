#include "bodies/stages.h"
#include "schemes/project.h"
#include "schemes/projection.h"

namespace tailwater {

template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report = project(flow, start, dt);
  report.interventions.stopped_at_walls += move(flow, start, dt);
  report.interventions += shift(flow, dt);
  locate(flow);
  const WallDrive<Dim> drive = drive_walls_to_end(flow, start, dt);
  flow.state.wall_velocity = drive.velocity;
  const SecondProjection second = reproject(flow, drive, dt);
  for (const auto& part : flow.parts) part->project_again(flow, second.correction, dt);
  carry_over_second_pressure(flow, second.correction, dt);
  ++report.passes;
  report.iterations += second.report.iterations;  // the residual stays that of the first solve, to the tolerance
  report.interventions += second.report.interventions;
  report.work.walls = wall_work(flow, dt);  // by the pressure of both projections
  report.work.ends = end_work(flow, dt);
  report.divergence = report_of_divergence(flow, divergence_to_report(flow));  // the last solve was where it ends
  return report;
}

TAILWATER_IN_2D_AND_3D(two_projections_step);

}  // namespace tailwater
