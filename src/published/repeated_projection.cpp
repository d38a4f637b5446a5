#include "published/repeated_projection.h"

#include <cmath>

#include "base/for_each.h"
#include "pressure/stages.h"
#include "schemes/project.h"

namespace tailwater {
namespace {

/// The iteration ends when the pressure changes by less than this fraction of its rms value, or after a maximum number
/// of passes. With the smallest factor below, 0.7^30 = 2e-5 of the initial difference remains by then.
constexpr double pass_tolerance = 1e-3;
constexpr int max_projections = 30;

/// The paper's under-relaxation, after (F27).
constexpr double relax_pressure = 0.4;
constexpr double relax_velocity = 0.3;
constexpr double relax_position = 0.4;

/// Surface marks may change up to the second pass. Later changes would prevent convergence of the iteration.
constexpr int passes_with_new_marks = 2;

/// x <- x_before + factor (x - x_before) on owned entries.
template <class Value>
void relax(double factor, const std::vector<Value>& before, std::vector<Value>& field) {
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
StepReport repeated_projection_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  StepReport report;
  WallDrive<Dim> drive = drive_walls(flow, start.wall_velocity, dt);
  const std::vector<double> no_target(particles.owned, 0.0);  // (F19)
  std::optional<std::vector<double>> divergence_old;
  for (bool settled = false; !settled && report.passes < max_projections;) {
    const auto pressure_before = owned_part(particles.pressure, particles.owned);
    const auto velocity_before = owned_part(particles.velocity, particles.owned);
    const auto position_before = owned_part(particles.position, particles.owned);

    const SurfaceMarks marks = report.passes < passes_with_new_marks ? SurfaceMarks::found : SurfaceMarks::kept;
    locate(flow, marks);                                          // derivatives at the positions of iterate k
    Prediction<Dim> predicted = predict(flow, start, drive, dt);  // (F21)
    const PosedEquation equation = assemble(flow, predicted, no_target, drive, dt);  // (F22)
    report.add(solve(flow, equation, drive));
    correct(flow, predicted, drive, dt);  // (F24)
    report.work = work_of_step(flow, start, predicted, equation, dt);
    divergence_old = divergence_to_report(flow);

    report.pressure_change = relative_change(flow.setup.ranks, pressure_before, particles.pressure);
    relax(relax_pressure, pressure_before, particles.pressure);
    relax(relax_velocity, velocity_before, particles.velocity);
    report.interventions.stopped_at_walls += move(flow, start, dt);  // (F25)
    relax(relax_position, position_before, particles.position);
    place_walls(flow, flow.state.time + dt);  // walls are not relaxed

    // The first pass starts from the previous step, not from an iterate of this one.
    settled = report.passes > 1 && report.pressure_change < pass_tolerance;
  }
  report.interventions += shift(flow, dt);  // (F28)-(F32)
  locate(flow);
  report.divergence = report_of_divergence(flow, divergence_old);  // (F19)
  return report;
}

TAILWATER_IN_2D_AND_3D(repeated_projection_step);

}  // namespace tailwater
