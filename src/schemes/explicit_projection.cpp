#include "schemes/projection.h"
#include "schemes/verbs.h"

namespace tailwater {

template <int Dim>
StepReport project(Flow<Dim>& flow, double dt) {
  StepReport report;
  report.dt = dt;
  report.passes = 1;
  remember(flow);
  drive_walls(flow, dt);
  locate(flow);
  predict(flow, dt);  // (F14)
  aim(flow, dt);
  assemble(flow, dt, report.interventions);  // (F15)
  const SolveReport solved = solve(flow, report.interventions);
  correct(flow, dt);  // (F16)
  book_work(flow, dt, report);
  report.iterations = solved.iterations;
  report.residual = solved.residual;
  return report;
}

template <int Dim>
StepReport explicit_projection_step(Flow<Dim>& flow, double dt) {
  StepReport report = project(flow, dt);
  report.divergence_old = bulk_divergence(flow);  // (F18): what is left at the old positions
  move(flow, dt, report.interventions);           // (F17)
  locate(flow);
  measure_after_move(flow, report);
  shift(flow, dt, report.interventions);  // (F28)-(F32)
  return report;
}

template StepReport project<2>(Flow<2>&, double);
template StepReport project<3>(Flow<3>&, double);
template StepReport explicit_projection_step<2>(Flow<2>&, double);
template StepReport explicit_projection_step<3>(Flow<3>&, double);

}  // namespace tailwater
