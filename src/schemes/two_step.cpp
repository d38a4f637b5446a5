#include "schemes/two_step.h"

#include "neighbours/halo.h"
#include "schemes/project.h"

namespace tailwater {

template <int Dim>
PredictedPressure<Dim> predict_pressure(Flow<Dim>& flow, const StepStart<Dim>& start, WallDrive<Dim>& drive,
                                        double dt) {
  PredictedPressure<Dim> found;
  locate(flow);                                       // rho (B6, B10)
  found.predicted = predict(flow, start, drive, dt);  // (B11), (B12)
  drift(flow, start, found.predicted, dt);            // (B13)
  locate(flow);                                       // rho_star (B14), surface (B21)
  flow.halo().exchange(found.predicted.velocity);     // other ghosts than before the drift
  const std::vector<double> no_target(flow.state.particles.owned, 0.0);
  found.equation = assemble(flow, found.predicted, no_target, drive, dt);  // (B17)
  found.solved = solve(flow, found.equation, drive);
  return found;
}

template <int Dim>
StepReport two_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report;
  WallDrive<Dim> drive = drive_walls(flow, start.wall_velocity, dt);
  const PredictedPressure<Dim> found = predict_pressure(flow, start, drive, dt);
  report.add(found.solved);
  correct(flow, found.predicted, drive, dt);  // (B16), (B18)
  report.work = work_of_step(flow, start, found.predicted, found.equation, dt);
  const auto divergence_old = divergence_to_report(flow);
  report.interventions.stopped_at_walls += move(flow, start, dt);  // (B19)
  report.interventions += shift(flow, dt);
  locate(flow);
  report.divergence = report_of_divergence(flow, divergence_old);
  return report;
}

TAILWATER_IN_2D_AND_3D(predict_pressure);
TAILWATER_IN_2D_AND_3D(two_step);

}  // namespace tailwater
