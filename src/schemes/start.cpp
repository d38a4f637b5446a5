#include "schemes/start.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flow/balanced_pressure.h"
#include "schemes/advance.h"
#include "schemes/two_step.h"

namespace tailwater {

template <int Dim>
void predict_pressure_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  WallDrive<Dim> drive = drive_walls_to_end(flow, start.wall_velocity, dt);
  predict_pressure(flow, start, drive, dt);
  find_wall_forces(flow);
  std::copy(start.position.begin(), start.position.end(), flow.state.particles.position.begin());
  place_walls(flow, flow.state.time);
  flow.surroundings.are_current = false;
  locate(flow);
}

template <int Dim>
void project_in_place(Flow<Dim>& flow, const StepStart<Dim>& start, WallDrive<Dim> drive, double dt) {
  Prediction<Dim> predicted = predict(flow, start, drive, dt);
  const std::vector<double> target = target_divergence(flow, std::move(predicted.velocity_gradient), dt);
  solve(flow, assemble(flow, predicted, target, drive, dt), drive);
  for (const auto& part : flow.parts) part->stay(flow);
  find_wall_forces(flow);
}

template <int Dim>
void project_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  project_in_place(flow, start, drive_walls_to_end(flow, start.wall_velocity, dt), dt);
}

template <int Dim>
void start(Flow<Dim>& flow) {
  const double dt = next_time_step(flow);
  assign_roles(flow);
  for (const auto& part : flow.parts) part->begin_step(flow, 0.0);
  const StepStart<Dim> start = save_step_start(flow);
  locate(flow);
  flow.state.last_step.approach = largest_approach(flow);
  find_balance(flow, true);
  if (flow.walls.forces.are_requested) flow.walls.forces.reset(flow.state.particles.owned);
  if (!std::isfinite(dt)) return;  // nothing moves and no force acts, so there is no pressure
  flow.setup.formulation.find_first_pressure(flow, start, dt);
  find_balance(flow);
}

TAILWATER_IN_2D_AND_3D(project_in_place);
TAILWATER_IN_2D_AND_3D(project_at_start);
TAILWATER_IN_2D_AND_3D(predict_pressure_at_start);
TAILWATER_IN_2D_AND_3D(start);

}  // namespace tailwater
