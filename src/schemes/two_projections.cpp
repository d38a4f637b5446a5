#include "schemes/project.h"
#include "schemes/projection.h"

namespace tailwater {

template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report = project(flow, start, dt);
  report.interventions.stopped_at_walls += move(flow, start, dt);
  report.interventions += shift(flow, dt);
  locate(flow);
  const WallDrive<Dim> drive = drive_walls_to_end(flow, start.wall_velocity, dt);
  flow.state.wall_velocity = drive.velocity;
  const SecondProjection second = reproject(flow, drive, dt);
  for (const auto& part : flow.parts) part->project_again(flow, second.correction, dt);
  ++report.passes;
  report.iterations += second.report.iterations;  // the residual stays that of the first solve, to the tolerance
  report.interventions += second.report.interventions;
  const Works boundaries = work_of_boundaries(flow, start, dt);  // by the pressure of both projections
  report.work.walls = boundaries.walls;
  report.work.ends = boundaries.ends;
  report.divergence = report_of_divergence(flow, divergence_to_report(flow));  // the last solve was where it ends
  return report;
}

TAILWATER_IN_2D_AND_3D(two_projections_step);

}  // namespace tailwater
