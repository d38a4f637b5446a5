#include "schemes/projection.h"
#include "schemes/verbs.h"

namespace tailwater {

namespace {

/// (F14)-(F17), and the neighbours at the new positions.
template <int Dim>
StepReport project_and_move(Flow<Dim>& flow, double dt) {
  StepReport report;
  report.dt = dt;
  report.passes = 1;
  remember(flow);
  locate(flow);
  predict(flow, dt);  // (F14)
  aim(flow, dt);
  assemble(flow, dt, report.interventions);  // (F15)
  const SolveReport solved = solve(flow, report.interventions);
  correct(flow, dt);                              // (F16)
  report.divergence_old = bulk_divergence(flow);  // (F18): what is left at the old positions
  move(flow, dt, report.interventions);           // (F17)

  report.iterations = solved.iterations;
  report.residual = solved.residual;
  locate(flow);
  return report;
}

}  // namespace

template <int Dim>
StepReport explicit_projection_step(Flow<Dim>& flow, double dt) {
  StepReport report = project_and_move(flow, dt);
  report.divergence_new = bulk_divergence(flow);  // (F19): and at the new ones
  shift(flow, dt, report.interventions);          // (F28)-(F32)
  return report;
}

template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, double dt) {
  StepReport report = project_and_move(flow, dt);
  const SolveReport solved = reproject(flow, dt, report.interventions);
  report.passes = 2;
  report.iterations += solved.iterations;
  report.residual = solved.residual;
  report.divergence_new = bulk_divergence(flow);  // (F19), at the positions of the second projection
  report.divergence_old = report.divergence_new;
  shift(flow, dt, report.interventions);
  return report;
}

template StepReport two_projections_step<2>(Flow<2>&, double);
template StepReport two_projections_step<3>(Flow<3>&, double);
template StepReport explicit_projection_step<2>(Flow<2>&, double);
template StepReport explicit_projection_step<3>(Flow<3>&, double);

}  // namespace tailwater
