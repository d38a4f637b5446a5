#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "bodies/verbs.h"
#include "schemes/project.h"
#include "schemes/projection.h"

namespace tailwater {
namespace {

/// Surface marks may change up to the second pass. Later changes would keep the iteration from settling.
constexpr int passes_with_new_marks = 2;

/// x <- x_before + factor (x - x_before) on owned entries.
template <class Value>
void relax(double factor, const std::vector<Value>& before, std::vector<Value>& field) {
  if (factor == 1.0) return;
  for_each(before.size(), [&](std::size_t i) { field[i] = before[i] + factor * (field[i] - before[i]); });
}

/// rms of the difference divided by the rms of `field`, over the owned entries of all ranks.
double relative_change(const Communicator& ranks, const std::vector<double>& before, const std::vector<double>& field) {
  double difference =
      sum_over(before.size(), 0.0, [&](std::size_t i) { return (field[i] - before[i]) * (field[i] - before[i]); });
  double size = sum_over(before.size(), 0.0, [&](std::size_t i) { return field[i] * field[i]; });
  ranks.sum_each(difference, size);
  return size > 0.0 ? std::sqrt(difference / size) : 0.0;
}

template <class Value>
std::vector<Value> owned_part(const std::vector<Value>& field, std::size_t owned) {
  return {field.begin(), field.begin() + static_cast<std::ptrdiff_t>(owned)};
}

}  // namespace

template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report = project(flow, start, dt);
  report.interventions.put_back += move(flow, start, dt);
  report.interventions += shift(flow, dt);
  locate(flow);
  const WallDrive<Dim> drive = drive_walls_to_end(flow, start, dt);
  flow.state.wall_velocity = drive.velocity;
  const SecondProjection second = reproject(flow, drive, dt);
  carry_over_second_pressure(flow, second.correction, dt);
  ++report.passes;
  report.iterations += second.report.iterations;  // the residual stays that of the first solve, to the tolerance
  report.interventions += second.report.interventions;
  report.work.walls = wall_work(flow, dt);  // by the pressure of both projections
  report.work.ends = end_work(flow, dt);
  report.divergence = report_of_divergence(flow, divergence_to_report(flow));  // the last solve was where it ends
  return report;
}

template <int Dim>
StepReport repeated_projection_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  const SchemeChoices& scheme = flow.setup.scheme;
  Particles<Dim>& particles = flow.state.particles;
  StepReport report;
  WallDrive<Dim> drive = drive_walls(flow, start, dt);
  const std::vector<double> no_target(particles.owned, 0.0);  // (F19)
  std::optional<std::vector<double>> divergence_old;
  for (bool settled = false; !settled && report.passes < scheme.max_passes;) {
    const auto pressure_before = owned_part(particles.pressure, particles.owned);
    const auto velocity_before = owned_part(particles.velocity, particles.owned);
    const auto position_before = owned_part(particles.position, particles.owned);

    locate(flow, report.passes >= passes_with_new_marks);         // derivatives at the positions of iterate k
    Prediction<Dim> predicted = predict(flow, start, drive, dt);  // (F21)
    if (report.passes == 0) grow_boundary_layers(flow, predicted);
    const PosedEquation equation = assemble(flow, predicted, no_target, drive, dt);  // (F22)
    report.add(solve(flow, equation, drive));
    correct(flow, predicted, drive, dt);  // (F24)
    report.work = book_works(flow, start, predicted, equation, dt);
    divergence_old = divergence_to_report(flow);

    report.pressure_change = relative_change(flow.setup.ranks, pressure_before, particles.pressure);
    relax(scheme.relax_pressure, pressure_before, particles.pressure);
    relax(scheme.relax_velocity, velocity_before, particles.velocity);
    report.interventions.put_back += move(flow, start, dt);  // (F25)
    relax(scheme.relax_position, position_before, particles.position);
    place_walls(flow, flow.state.time + dt);  // walls are not relaxed

    // The first pass starts from the previous step, not from an iterate of this one.
    settled = report.passes > 1 && report.pressure_change < scheme.pass_tolerance;
  }
  report.interventions += shift(flow, dt);  // (F28)-(F32)
  locate(flow);
  report.divergence = report_of_divergence(flow, divergence_old);  // (F19)
  return report;
}

#define TAILWATER_INSTANTIATE(Dim)                                                          \
  template StepReport two_projections_step<Dim>(Flow<Dim>&, const StepStart<Dim>&, double); \
  template StepReport repeated_projection_step<Dim>(Flow<Dim>&, const StepStart<Dim>&, double);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
