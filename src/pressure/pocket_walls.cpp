// Walls that move beside pockets. The space that a wall leaves to a pocket is counted as far as the wall sees its air:
// where it is dry, and in the rows of water from whose last one on the water's own flow counts. The air pushes the wall
// on the same pieces, so the work of the gas is that on water and walls. The pairs of water and wall do the rest: in
// them the pressure counts from that of the air.
#include "flow/air_pressure.h"
#include "pressure/pockets.h"

namespace tailwater {

template <int Dim>
double pressure_at(const PocketWall<Dim>& wall, std::span<const double> air) {
  double sum = 0.0;
  for (const PocketShare& share : wall.shares) sum += share.share * air[share.pocket];
  return sum;
}

template <int Dim>
std::vector<double> growth_by_walls(const Flow<Dim>& flow, double dt) {
  std::vector<double> growth(flow.state.air.pockets.size(), 0.0);
  if (dt == 0.0) return growth;
  const double time = flow.state.time;
  MotionState<Dim> state = flow.state.motion;
  for (BodyState<Dim>& body : state.bodies.each) body.velocity -= 0.5 * dt * body.acceleration;
  for (const auto& moving : flow.setup.wall_motion.moving()) {
    const AffineMap<Dim> now = moving.at(time, state);
    const AffineMap<Dim> velocity = moving.mean_velocity(time, time + dt, state);
    for (const PocketWall<Dim>& wall : flow.sides.walls) {
      if (wall.wall != moving.wall) continue;
      const double flux = wall.area.dot(velocity(now.inverse(wall.x)));
      for (const PocketShare& share : wall.shares) growth[share.pocket] += share.share * flux;
    }
  }
  return growth;
}

template <int Dim>
void subtract_seen(const Flow<Dim>& flow, std::span<const double> air, std::vector<double>& field) {
  for (const auto& [i, seen] : flow.sides.seen) field[i] -= seen.share * air[seen.pocket];
  flow.halo().exchange(field);
}

TAILWATER_IN_2D_AND_3D(pressure_at);
TAILWATER_IN_2D_AND_3D(growth_by_walls);
TAILWATER_IN_2D_AND_3D(subtract_seen);

}  // namespace tailwater
