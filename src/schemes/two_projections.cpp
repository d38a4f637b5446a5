#include <vector>

#include "base/for_each.h"
#include "motion/wall_motion.h"
#include "schemes/project.h"
#include "schemes/projection.h"

namespace tailwater {
namespace {

/// The velocities of rows of walls, turned with their walls in a step of dt. The pressure of both projections is that
/// of the places where the step ends; velocities from its start must have the directions of these places.
template <int Dim>
std::vector<Vec<Dim>> turned_with_walls(const Flow<Dim>& flow, std::vector<Vec<Dim>> velocity, double dt) {
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    const Mat<Dim> before = moving.at(flow.state.time, flow.state.motion).linear;
    const Mat<Dim> turn = moving.at(flow.state.time + dt, flow.state.motion).linear * before.transpose();
    for_each(velocity.size(), [&](std::size_t row) {
      if (flow.walls.particles.wall[row] == moving.wall) velocity[row] = turn * velocity[row];
    });
  }
  return velocity;
}

}  // namespace

template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  StepReport report = project(flow, start, dt);
  report.interventions.stopped_at_walls += move(flow, start, dt);
  report.interventions += shift(flow, dt);
  locate(flow);
  const WallDrive<Dim> drive = drive_walls_to_end(flow, start.wall_velocity, dt);
  flow.state.wall_velocity = drive.velocity;
  const SecondProjection second = reproject(flow, drive, dt);
  for (const auto& part : flow.parts) part->project_again(flow, second.correction, dt);
  ++report.passes;
  report.iterations += second.report.iterations;  // the residual stays that of the first solve, to the tolerance
  report.interventions += second.report.interventions;
  const Works boundaries =  // by the pressure of both projections
      work_of_boundaries<Dim>(flow, turned_with_walls(flow, start.wall_velocity, dt), dt);
  report.work.walls = boundaries.walls;
  report.work.ends = boundaries.ends;
  report.divergence = report_of_divergence(flow, divergence_to_report(flow));  // the last solve was where it ends
  return report;
}

TAILWATER_IN_2D_AND_3D(two_projections_step);

}  // namespace tailwater
