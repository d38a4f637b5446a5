#include "base/for_each.h"
#include "flow/stages.h"
#include "motion/wall_motion.h"
#include "neighbours/neighbourhood.h"
#include "operators/graded_sums.h"
#include "walls/turning_walls.h"
#include "walls/wall_model.h"

namespace tailwater {
namespace {

/// Adds the acceleration that takes the walls from their velocity at the start of the step to `velocity` after dt.
template <int Dim>
WallDrive<Dim> drive_to(const Flow<Dim>& flow, const std::vector<Vec<Dim>>& from, std::vector<Vec<Dim>> velocity,
                        double dt) {
  WallDrive<Dim> drive{std::move(velocity), {}};
  drive.acceleration.resize(drive.velocity.size());
  for_each(drive.velocity.size(), [&](std::size_t row) {
    drive.acceleration[row] = flow.walls.particles.blocked[row] * (drive.velocity[row] - from[row]) / dt;
  });
  return drive;
}

/// Moves the zones of refinement to where they are at a time.
template <int Dim>
void place_zones(const Flow<Dim>& flow, double time) {
  if (flow.setup.graded == nullptr || !flow.setup.graded->field().moves()) return;
  const SpacingField<Dim>& field = flow.setup.graded->field();
  if (field.carrier() < 0) {
    field.carry(Mat<Dim>::Identity(), field.displacement(time));
    return;
  }
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    if (moving.wall != field.carrier()) continue;
    const AffineMap<Dim> carried = moving.at(time, flow.state.motion);
    field.carry(carried.linear, carried.constant);
  }
}

}  // namespace

template <int Dim>
WallDrive<Dim> drive_walls(const Flow<Dim>& flow, const std::vector<Vec<Dim>>& from, double dt) {
  if (flow.setup.formulation.moves_with_mean_velocity) return drive_walls_to_end(flow, from, dt);
  std::vector<Vec<Dim>> velocity = from;
  const double time = flow.state.time;
  flow.setup.wall_motion->get_mean_velocity(time, time + dt, flow.state.motion, velocity);
  return drive_to(flow, from, std::move(velocity), dt);
}

template <int Dim>
WallDrive<Dim> drive_walls_to_end(const Flow<Dim>& flow, const std::vector<Vec<Dim>>& from, double dt) {
  std::vector<Vec<Dim>> velocity = from;
  flow.setup.wall_motion->get_velocity(flow.state.time + dt, flow.state.motion, velocity);
  return drive_to(flow, from, std::move(velocity), dt);
}

template <int Dim>
void place_walls(Flow<Dim>& flow, double time) {
  place_zones(flow, time);
  const WallMotion<Dim>& motion = *flow.setup.wall_motion;
  if (motion.moving().empty()) return;
  motion.place(time, flow.state.motion, flow.walls.boundary, flow.walls.particles);
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) return;
    const auto row = particles.wall_row[i];
    if (!flow.walls.boundary.walls[flow.walls.particles.wall[row]].moves()) return;
    particles.position[i] = flow.neighbourhood->wrapped(flow.walls.particles.position[row]);
  });
}

template <int Dim>
WallDisplacements<Dim> displacements_of_walls(const Flow<Dim>& flow, double dt) {
  const WallMotion<Dim>& motion = *flow.setup.wall_motion;
  WallDisplacements<Dim> displacements;
  if (motion.moving().empty()) return displacements;
  displacements.dt = dt;
  displacements.of_wall.resize(flow.walls.boundary.walls.size());
  for (const auto& moving : motion.moving()) {
    displacements.of_wall[moving.wall] = displacement_between(moving.at(flow.state.time, flow.state.motion),
                                                              moving.at(flow.state.time + dt, flow.state.motion));
  }
  return displacements;
}

template <int Dim>
void set_wall_velocities(const Flow<Dim>& flow, std::span<const Vec<Dim>> V, std::vector<Vec<Dim>>& velocity) {
  flow.halo().exchange(velocity);
  flow.wall_model().show_velocity(flow.wall_scene(), V, velocity);
  flow.halo().exchange(velocity);
}

template <int Dim>
void set_wall_velocities_at_mid_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt,
                                     std::vector<Vec<Dim>>& velocity) {
  const WallMotion<Dim>& motion = *flow.setup.wall_motion;
  const bool may_turn = flow.walls.is_curved || !motion.moving().empty();
  if (!flow.setup.formulation.is_divergence_free_midway || !may_turn) return;
  WallTurns<Dim> turns{
      .dt = dt, .from_drawn = {}, .in_step = {}, .comes_from_chord = !flow.setup.formulation.has_second_projection};
  if (!motion.moving().empty()) {
    turns.from_drawn.resize(flow.walls.boundary.walls.size());
    turns.in_step.resize(turns.from_drawn.size());
  }
  for (const auto& moving : motion.moving()) {
    const Mat<Dim> now = moving.at(flow.state.time, flow.state.motion).linear;
    turns.from_drawn[moving.wall] = now;
    turns.in_step[moving.wall] = moving.at(flow.state.time + dt, flow.state.motion).linear * now.transpose();
  }
  flow.walls.turn_acceleration.resize(flow.state.particles.owned);
  follow_turning_walls<Dim>(flow.wall_scene(), turns, start.wall_velocity, velocity, flow.walls.turn_acceleration);
  flow.halo().exchange(velocity);
}

TAILWATER_IN_2D_AND_3D(drive_walls);
TAILWATER_IN_2D_AND_3D(drive_walls_to_end);
TAILWATER_IN_2D_AND_3D(place_walls);
TAILWATER_IN_2D_AND_3D(displacements_of_walls);
TAILWATER_IN_2D_AND_3D(set_wall_velocities);
TAILWATER_IN_2D_AND_3D(set_wall_velocities_at_mid_step);

}  // namespace tailwater
