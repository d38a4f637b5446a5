#include "schemes/project.h"

#include <utility>

#include "base/for_each.h"
#include "pressure/operators.h"
#include "pressure/verbs.h"

namespace tailwater {

template <int Dim>
StepReport project(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report;
  WallDrive<Dim> drive = drive_walls(flow, start, dt);
  locate(flow);
  Prediction<Dim> predicted = predict(flow, start, drive, dt);  // (F14)
  grow_boundary_layers(flow, predicted);
  const PosedEquation equation =
      assemble(flow, predicted, aim(flow, std::move(predicted.velocity_gradient), dt), drive, dt);  // (F15)
  report.add(solve(flow, start, equation, dt, drive));
  correct(flow, predicted, drive, dt);  // (F16)
  report.work = book_works(flow, start, predicted, equation, dt);
  return report;
}

template <int Dim>
void report_divergence(Flow<Dim>& flow, const std::vector<double>& divergence_old, StepReport& report) {
  const std::vector<double> divergence = find_divergence(flow, reported_stride);
  std::vector<double> change(divergence.size());
  for_each(change.size(), [&](std::size_t i) { change[i] = divergence_old[i] - divergence[i]; });
  report.divergence_new = bulk_rms(flow, divergence, reported_stride);
  report.divergence_moved = bulk_rms(flow, change, reported_stride);
}

template StepReport project<2>(Flow<2>&, const StepStart<2>&, double);
template StepReport project<3>(Flow<3>&, const StepStart<3>&, double);
template void report_divergence<2>(Flow<2>&, const std::vector<double>&, StepReport&);
template void report_divergence<3>(Flow<3>&, const std::vector<double>&, StepReport&);

}  // namespace tailwater
