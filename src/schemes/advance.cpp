#include "schemes/advance.h"

#include "bodies/verbs.h"

namespace tailwater {
template <int Dim>
StepReport advance(Flow<Dim>& flow, double dt) {
  gather_walls(flow);
  assign_roles(flow);
  hold_open_ends(flow, dt);
  steer_wave_makers(flow);
  watch_air(flow, dt);
  const StepStart<Dim> start = remember(flow);
  steer_bodies(flow, start, dt);
  StepReport report = flow.setup.formulation.take_step(flow, start, dt);
  report.dt = dt;
  flow.halo().exchange(flow.state.particles.velocity);
  flow.state.approach = largest_approach(flow);
  count_passing(flow, start);
  Interventions& counts = report.interventions;
  flow.setup.ranks.sum_each(counts.stopped_at_walls, counts.capped_shifts, counts.fallback_rows);
  balance_energy(flow, start, report);
  carry_over_guard(flow, dt);
  flow.state.time += dt;
  for (BodyState<Dim>& body : flow.state.motion.bodies.each) body.go_on(flow.state.time);
  ++flow.state.step;
  return report;
}

TAILWATER_IN_2D_AND_3D(advance);

}  // namespace tailwater
