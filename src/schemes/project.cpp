#include "schemes/project.h"

#include <utility>

#include "base/for_each.h"
#include "pressure/operators.h"

namespace tailwater {
namespace {

constexpr std::int64_t steps_between_reports = 10;

}  // namespace

template <int Dim>
StepReport project(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report;
  WallDrive<Dim> drive = drive_walls(flow, start.wall_velocity, dt);
  locate(flow);
  Prediction<Dim> predicted = predict(flow, start, drive, dt);  // (F14)
  set_wall_velocities_at_mid_step(flow, start, dt, predicted.velocity);
  const PosedEquation equation = assemble(
      flow, predicted, target_divergence(flow, std::move(predicted.velocity_gradient), dt), drive, dt);  // (F15)
  report.add(solve(flow, equation, drive));
  correct(flow, predicted, drive, dt);  // (F16)
  report.work = work_of_step(flow, start, predicted, equation, dt);
  return report;
}

template <int Dim>
std::optional<std::vector<double>> divergence_to_report(Flow<Dim>& flow) {
  if (flow.state.step % steps_between_reports != 0) return {};
  return find_divergence(flow);
}

template <int Dim>
std::optional<DivergenceReport> report_of_divergence(Flow<Dim>& flow, const std::optional<std::vector<double>>& old) {
  if (!old) return {};
  const double rms_of_old = bulk_rms(flow, *old);
  const std::vector<double> divergence = find_divergence(flow);
  std::vector<double> change(divergence.size());
  for_each(change.size(), [&](std::size_t i) { change[i] = (*old)[i] - divergence[i]; });
  return DivergenceReport{rms_of_old, bulk_rms(flow, divergence), bulk_rms(flow, change)};
}

TAILWATER_IN_2D_AND_3D(project);
TAILWATER_IN_2D_AND_3D(divergence_to_report);
TAILWATER_IN_2D_AND_3D(report_of_divergence);

}  // namespace tailwater
