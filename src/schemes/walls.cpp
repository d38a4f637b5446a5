#include "base/for_each.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

/// The acceleration that leads from the old velocity to the next.
template <int Dim>
void accelerate_walls(Flow<Dim>& flow, double dt) {
  for_each(flow.wall_acceleration.size(), [&](std::size_t row) {
    flow.wall_acceleration[row] =
        flow.walls.particles.blocked[row] * (flow.wall_velocity_next[row] - flow.wall_velocity_old[row]) / dt;
  });
}

}  // namespace

template <int Dim>
void drive_walls(Flow<Dim>& flow, double dt) {
  flow.wall_velocity_next = flow.wall_velocity_old;
  if (flow.scheme.displacement == Displacement::mean_velocity) {
    flow.wall_motion.get_velocity(flow.time + dt, flow.wall_velocity_next);
  } else {
    flow.wall_motion.get_mean_velocity(flow.time, flow.time + dt, flow.wall_velocity_next);
  }
  accelerate_walls(flow, dt);
}

template <int Dim>
void drive_walls_to_end(Flow<Dim>& flow, double dt) {
  flow.wall_velocity_next = flow.wall_velocity_old;
  flow.wall_motion.get_velocity(flow.time + dt, flow.wall_velocity_next);
  accelerate_walls(flow, dt);
}

template <int Dim>
void place_walls(Flow<Dim>& flow, double time) {
  if (flow.wall_motion.moving().empty()) return;
  flow.wall_motion.place(time, flow.boundary, flow.walls.particles);
  Particles<Dim>& particles = flow.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) return;
    const auto row = particles.wall_row[i];
    if (!flow.boundary.walls[flow.walls.particles.wall[row]].moves()) return;
    particles.position[i] = flow.neighbourhood.wrapped(flow.walls.particles.position[row]);
  });
}

template <int Dim>
WallWays<Dim> ways_of_walls(const Flow<Dim>& flow, double dt) {
  WallWays<Dim> ways;
  if (flow.wall_motion.moving().empty()) return ways;
  ways.dt = dt;
  ways.way.resize(flow.boundary.walls.size());
  for (const auto& moving : flow.wall_motion.moving()) {
    ways.way[moving.wall] = way_between(moving.path.at(flow.time), moving.path.at(flow.time + dt));
  }
  return ways;
}

template void drive_walls<2>(Flow<2>&, double);
template void drive_walls<3>(Flow<3>&, double);
template void drive_walls_to_end<2>(Flow<2>&, double);
template void drive_walls_to_end<3>(Flow<3>&, double);
template void place_walls<2>(Flow<2>&, double);
template void place_walls<3>(Flow<3>&, double);
template WallWays<2> ways_of_walls<2>(const Flow<2>&, double);
template WallWays<3> ways_of_walls<3>(const Flow<3>&, double);

}  // namespace tailwater
