#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "schemes/projection.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// Surface marks may still change in the second pass; later they would keep the iteration from settling (method.md 4).
constexpr int passes_with_new_marks = 2;

/// x <- x_before + factor (x - x_before) on owned entries.
template <class Value>
void relax(double factor, const std::vector<Value>& before, std::vector<Value>& field) {
  if (factor == 1.0) return;
  for_each(before.size(), [&](std::size_t i) { field[i] = before[i] + factor * (field[i] - before[i]); });
}

/// rms of the difference over the rms of `field`, owned entries of all ranks.
double relative_change(const Communicator& ranks, const std::vector<double>& before, const std::vector<double>& field) {
  double difference = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    difference += (field[i] - before[i]) * (field[i] - before[i]);
    size += field[i] * field[i];
  }
  ranks.sum_each(difference, size);
  return size > 0.0 ? std::sqrt(difference / size) : 0.0;
}

template <class Value>
std::vector<Value> owned_part(const std::vector<Value>& field, std::size_t owned) {
  return {field.begin(), field.begin() + static_cast<std::ptrdiff_t>(owned)};
}

template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, double dt) {
  StepReport report = project(flow, dt);
  move(flow, dt, report.interventions);
  locate(flow);
  drive_walls_to_end(flow, dt);
  flow.walls.velocity = flow.wall_velocity_next;
  report.iterations += reproject(flow, dt, report.interventions).iterations;
  report.wall_work = wall_work(flow, dt);  // of the pressure of both
  report.passes = 2;
  report.divergence_new = report.divergence_old = bulk_divergence(flow);  // the solve was at the new positions
  shift(flow, dt, report.interventions);
  return report;
}

template <int Dim>
StepReport repeated_projection_step(Flow<Dim>& flow, double dt) {
  StepReport report;
  report.dt = dt;
  Particles<Dim>& particles = flow.particles;
  remember(flow);
  drive_walls(flow, dt);
  flow.target_divergence.assign(particles.owned, 0.0);  // (F19)
  for (bool settled = false; !settled && report.passes < flow.scheme.max_passes; ++report.passes) {
    const auto pressure_before = owned_part(particles.pressure, particles.owned);
    const auto velocity_before = owned_part(particles.velocity, particles.owned);
    const auto position_before = owned_part(particles.position, particles.owned);

    locate(flow, report.passes >= passes_with_new_marks);  // derivatives at the positions of iterate k
    predict(flow, dt);                                     // (F21)
    assemble(flow, dt, report.interventions);              // (F22)
    const SolveReport solved = solve(flow, report.interventions);
    correct(flow, dt);  // (F24)
    book_work(flow, dt, report);
    report.divergence_old = bulk_divergence(flow);

    report.pressure_change = relative_change(flow.ranks, pressure_before, particles.pressure);
    relax(flow.scheme.relax_pressure, pressure_before, particles.pressure);
    relax(flow.scheme.relax_velocity, velocity_before, particles.velocity);
    move(flow, dt, report.interventions);  // (F25)
    relax(flow.scheme.relax_position, position_before, particles.position);
    place_walls(flow, flow.time + dt);  // walls are not relaxed

    report.iterations += solved.iterations;
    report.residual = solved.residual;
    // The first pass comes from the step before, not from an iterate of this one.
    settled = report.passes > 0 && report.pressure_change < flow.scheme.pass_tolerance;
  }
  locate(flow);
  measure_after_move(flow, report);       // (F19)
  shift(flow, dt, report.interventions);  // (F28)-(F32)
  return report;
}

}  // namespace

template <int Dim>
StepReport implicit_projection_step(Flow<Dim>& flow, double dt) {
  return flow.scheme.implicit_form == ImplicitForm::residual ? two_projections_step(flow, dt)
                                                             : repeated_projection_step(flow, dt);
}

template StepReport implicit_projection_step<2>(Flow<2>&, double);
template StepReport implicit_projection_step<3>(Flow<3>&, double);

}  // namespace tailwater
