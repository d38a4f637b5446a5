#include "schemes/advance.h"

#include "schemes/projection.h"
#include "schemes/two_step.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

template <int Dim>
StepReport take_step(Flow<Dim>& flow, double dt) {
  if (flow.scheme.name == SchemeName::farmani2020) return two_step(flow, dt);
  return flow.scheme.integrator == Integrator::explicit_projection ? explicit_projection_step(flow, dt)
                                                                   : implicit_projection_step(flow, dt);
}

}  // namespace

template <int Dim>
StepReport advance(Flow<Dim>& flow, double dt) {
  hold_open_ends(flow, dt);
  StepReport report = take_step(flow, dt);
  Interventions& counts = report.interventions;
  flow.ranks.sum_each(counts.put_back, counts.capped_shifts, counts.clamped_pressures, counts.fallback_rows);
  balance_energy(flow, report);
  flow.time += dt;
  ++flow.step;
  return report;
}

template StepReport advance<2>(Flow<2>&, double);
template StepReport advance<3>(Flow<3>&, double);

}  // namespace tailwater
