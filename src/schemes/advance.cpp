#include "schemes/advance.h"

#include "bodies/stages.h"

namespace tailwater {

template <int Dim>
StepStart<Dim> begin_step(Flow<Dim>& flow, double dt) {
  gather_walls(flow);
  assign_roles(flow);
  update_open_ends(flow, dt);
  watch_air(flow);
  for (const auto& part : flow.parts) part->begin_step(flow, dt);
  StepStart<Dim> start = save_step_start(flow);
  steer_bodies(flow, start, dt);
  return start;
}

template <int Dim>
StepReport advance(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report = flow.setup.formulation.take_step(flow, start, dt);
  report.dt = dt;
  flow.halo().exchange(flow.state.particles.velocity, flow.state.particles.pressure);  // probes read ghosts
  flow.state.approach = largest_approach(flow);
  for (const auto& part : flow.parts) part->finish_step(flow, start, dt);
  Interventions& counts = report.interventions;
  flow.setup.ranks.sum_each(counts.stopped_at_walls, counts.capped_shifts, counts.fallback_rows);
  balance_energy(flow, start, report);
  carry_over_guard(flow, dt);
  flow.state.time += dt;
  for (BodyState<Dim>& body : flow.state.motion.bodies.each) body.go_on(flow.state.time);
  ++flow.state.step;
  return report;
}

template StepReport advance<2>(Flow<2>&, const StepStart<2>&, double);
template StepReport advance<3>(Flow<3>&, const StepStart<3>&, double);
TAILWATER_IN_2D_AND_3D(begin_step);

}  // namespace tailwater
