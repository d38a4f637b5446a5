#include "flow/verbs.h"

namespace tailwater {
namespace {

/// The velocity of moving walls in a step of dt from now on.
template <int Dim>
typename AirWatch<Dim>::WallVelocity velocity_of_walls(const Flow<Dim>& flow, double dt) {
  return [&flow, dt](int wall, const Vec<Dim>& x) {
    const double time = flow.state.time;
    for (const auto& moving : flow.setup.wall_motion.moving()) {
      if (moving.wall != wall || dt == 0.0) continue;
      const Vec<Dim> drawn = moving.at(time, flow.state.motion).inverse(x);
      return moving.mean_velocity(time, time + dt, flow.state.motion)(drawn);
    }
    return Vec<Dim>(Vec<Dim>::Zero());
  };
}

}  // namespace

template <int Dim>
void watch_air(Flow<Dim>& flow, double dt) {
  if (!flow.air.is_on()) return;
  AirState& state = flow.state.air;
  if (flow.air.is_due(state)) {
    flow.air.look(flow.walls, velocity_of_walls(flow, dt), flow.state.particles, flow.setup.ranks, state);
  }
  state.displacement += dt * flow.setup.time_step_rule.limiting_speed(largest_speed(flow));
}

TAILWATER_IN_2D_AND_3D(watch_air);

}  // namespace tailwater
