#include "schemes/first_step.h"

#include <algorithm>
#include <utility>

#include "base/assert.h"
#include "base/for_each.h"
#include "flow/stages.h"
#include "motion/wall_motion.h"
#include "schemes/start.h"

namespace tailwater {
namespace {

/// Whether walls with a prescribed motion are accelerated; bodies have their velocity at the end of the step.
template <int Dim>
bool is_accelerated(const Flow<Dim>& flow, const WallDrive<Dim>& drive) {
  std::vector<bool> has_path(flow.walls.boundary.walls.size(), false);
  for (const auto& moving : flow.setup.wall_motion->moving()) has_path[moving.wall] = moving.body < 0;
  for (std::size_t row = 0; row < drive.acceleration.size(); ++row) {
    if (has_path[flow.walls.particles.wall[row]] && !drive.acceleration[row].isZero(0.0)) return true;
  }
  return false;
}

/// Adds `factor` times the forces of pressure.
template <int Dim>
void add(WallForces<Dim>& forces, const WallForces<Dim>& others, double factor) {
  TAILWATER_ASSERT(forces.pressure.size() == others.pressure.size(), "both are forces at the same positions");
  TAILWATER_ASSERT(forces.beside_walls.size() == others.beside_walls.size(), "the same hulls are beside walls");
  for_each(forces.pressure.size(), [&](std::size_t i) {
    forces.pressure[i] += factor * others.pressure[i];
    forces.through_water[i] += factor * others.through_water[i];
  });
  TAILWATER_ASSERT(forces.of_balanced.size() == others.of_balanced.size(), "the same walls are wet");
  for_each(forces.of_balanced.size(), [&](std::size_t i) { forces.of_balanced[i] += factor * others.of_balanced[i]; });
  for (std::size_t n = 0; n < forces.beside_walls.size(); ++n) {
    forces.beside_walls[n].force += factor * others.beside_walls[n].force;
    forces.beside_walls[n].moment += factor * others.beside_walls[n].moment;
  }
}

/// The pressure and its forces where walls are driven so, with all else as at the start of the step.
template <int Dim>
MissingInertia<Dim> pressure_by(Flow<Dim>& flow, const StepStart<Dim>& start, WallDrive<Dim> drive, double dt) {
  project_in_place(flow, start, std::move(drive), dt);
  return {flow.state.particles.pressure, flow.walls.acceleration, flow.walls.forces};
}

}  // namespace

template <int Dim>
std::optional<MissingInertia<Dim>> find_missing_inertia(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) {
  if (flow.state.step > 0 || flow.setup.formulation.moves_with_mean_velocity) return {};
  const WallDrive<Dim> to_middle = drive_walls(flow, start.wall_velocity, dt);
  if (!is_accelerated(flow, to_middle)) return {};
  locate(flow);
  const MotionState<Dim> motion = flow.state.motion;
  const std::vector<Vec<Dim>> velocity = flow.state.particles.velocity;
  const std::vector<double> pressure = flow.state.particles.pressure;
  const MissingInertia<Dim> half = pressure_by(flow, start, to_middle, dt);
  flow.state.motion = motion;
  MissingInertia<Dim> missing = pressure_by(flow, start, drive_walls_to_end(flow, start.wall_velocity, dt), dt);
  flow.state.motion = motion;
  flow.state.particles.velocity = velocity;
  flow.state.particles.pressure = pressure;
  for_each(missing.pressure.size(), [&](std::size_t i) { missing.pressure[i] -= half.pressure[i]; });
  for_each(missing.acceleration.size(), [&](std::size_t row) { missing.acceleration[row] -= half.acceleration[row]; });
  add(missing.forces, half.forces, -1.0);
  return missing;
}

template <int Dim>
void add_missing_inertia(const MissingInertia<Dim>& missing, Flow<Dim>& flow) {
  std::vector<double>& pressure = flow.state.particles.pressure;
  TAILWATER_ASSERT(pressure.size() == missing.pressure.size(), "the particles are where the inertia was computed");
  for_each(pressure.size(), [&](std::size_t i) { pressure[i] += missing.pressure[i]; });
  std::vector<Vec<Dim>>& acceleration = flow.walls.acceleration;
  for_each(acceleration.size(), [&](std::size_t row) { acceleration[row] += missing.acceleration[row]; });
  add(flow.walls.forces, missing.forces, 1.0);
}

TAILWATER_IN_2D_AND_3D(find_missing_inertia);
TAILWATER_IN_2D_AND_3D(add_missing_inertia);

}  // namespace tailwater
