#include "schemes/advance.h"

#include "flow/balanced_pressure.h"
#include "neighbours/halo.h"

namespace tailwater {

template <int Dim>
StepStart<Dim> begin_step(Flow<Dim>& flow, double dt) {
  gather_walls(flow);
  assign_roles(flow);
  for (const auto& part : flow.parts) part->begin_step(flow, dt);
  return save_step_start(flow);
}

template <int Dim>
StepReport advance(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report = flow.setup.formulation.take_step(flow, start, dt);
  report.dt = dt;
  flow.halo().exchange(flow.state.particles.velocity, flow.state.particles.pressure);  // probes read ghosts
  flow.state.last_step.approach = largest_approach(flow);
  find_balance(flow);
  for (const auto& part : flow.parts) part->finish_step(flow, start, dt);
  Interventions& counts = report.interventions;
  flow.setup.ranks.sum_each(counts.stopped_at_walls, counts.capped_shifts, counts.fallback_rows);
  balance_energy(flow, start, report);
  flow.state.time += dt;
  ++flow.state.step;
  return report;
}

template StepReport advance<2>(Flow<2>&, const StepStart<2>&, double);
template StepReport advance<3>(Flow<3>&, const StepStart<3>&, double);
TAILWATER_IN_2D_AND_3D(begin_step);

}  // namespace tailwater
