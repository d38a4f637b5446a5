#include <algorithm>

#include "base/for_each.h"
#include "flow/measure.h"
#include "flow/stages.h"

namespace tailwater {
namespace {

/// m; where vents are now: one that is on a wall that moves goes along.
template <int Dim>
std::vector<Vec<Dim>> places_of_vents(const Flow<Dim>& flow) {
  std::vector<Vec<Dim>> places;
  for (const VentPlace<Dim>& vent : flow.setup.vents) {
    places.push_back(vent.at);
    for (const auto& moving : flow.setup.wall_motion.moving()) {
      if (moving.wall == vent.wall) places.back() = moving.at(flow.state.time, flow.state.motion)(vent.at);
    }
  }
  return places;
}

}  // namespace

template <int Dim>
void watch_air(Flow<Dim>& flow) {
  AirState& state = flow.state.air;
  if (!flow.air.is_due(state)) return;
  flow.air.look(flow.walls, places_of_vents(flow), flow.state.particles, flow.setup.ranks, state);
}

template <int Dim>
void count_displacement_for_air(Flow<Dim>& flow, double dt) {
  if (!flow.air.is_on()) return;
  const double time = flow.state.time;
  const double walls = flow.setup.wall_motion.largest_displacement(time, time + dt, flow.state.motion);
  const double anywhere = std::max(dt * flow.setup.time_step_rule.limiting_speed(largest_speed(flow)), walls);
  double beside = 0.0;
  if (!flow.state.air.pockets.empty()) {
    const std::vector<Vec<Dim>>& velocity = flow.state.particles.velocity;
    const double speed = largest_over(flow.sides.water.size(), 0.0,
                                      [&](std::size_t n) { return velocity[flow.sides.water[n].particle].norm(); });
    beside = std::max(dt * flow.setup.ranks.largest(speed), walls);
  }
  flow.state.air.displacement += std::max(beside, 0.25 * anywhere);
}

TAILWATER_IN_2D_AND_3D(watch_air);
TAILWATER_IN_2D_AND_3D(count_displacement_for_air);

}  // namespace tailwater
