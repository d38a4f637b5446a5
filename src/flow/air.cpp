#include <algorithm>

#include "flow/verbs.h"

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
void watch_air(Flow<Dim>& flow, double dt) {
  if (!flow.air.is_on()) return;
  AirState& state = flow.state.air;
  if (flow.air.is_due(state)) {
    flow.air.look(flow.walls, places_of_vents(flow), flow.state.particles, flow.setup.ranks, state);
  }
  if (!state.pockets.empty()) return;  // what is beside them is known in the step (push_by_pockets)
  const double time = flow.state.time;
  state.displacement += std::max(dt * flow.setup.time_step_rule.limiting_speed(largest_speed(flow)),
                                 flow.setup.wall_motion.largest_displacement(time, time + dt, flow.state.motion));
}

TAILWATER_IN_2D_AND_3D(watch_air);

}  // namespace tailwater
