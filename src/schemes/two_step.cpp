#include "schemes/two_step.h"

#include "schemes/verbs.h"

namespace tailwater {

template <int Dim>
SolveReport predict_pressure(Flow<Dim>& flow, double dt, Interventions& interventions) {
  remember(flow);
  drive_walls(flow, dt);
  locate(flow);       // rho (B6, B10)
  predict(flow, dt);  // (B11), (B12)
  drift(flow, dt);    // (B13)
  locate(flow);       // rho_star (B14), surface (B21)
  flow.target_divergence.assign(flow.particles.owned, 0.0);
  assemble(flow, dt, interventions);  // (B17)
  return solve(flow, interventions);
}

template <int Dim>
StepReport two_step(Flow<Dim>& flow, double dt) {
  StepReport report;
  report.dt = dt;
  report.passes = 1;
  const SolveReport solved = predict_pressure(flow, dt, report.interventions);
  report.iterations = solved.iterations;
  report.residual = solved.residual;
  correct(flow, dt);  // (B16), (B18)
  book_work(flow, dt, report);
  report.divergence_old = bulk_divergence(flow);
  move(flow, dt, report.interventions);  // (B19)
  locate(flow);
  measure_after_move(flow, report);
  shift(flow, dt, report.interventions);
  return report;
}

template SolveReport predict_pressure<2>(Flow<2>&, double, Interventions&);
template SolveReport predict_pressure<3>(Flow<3>&, double, Interventions&);
template StepReport two_step<2>(Flow<2>&, double);
template StepReport two_step<3>(Flow<3>&, double);

}  // namespace tailwater
