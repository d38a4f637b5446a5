// Openings that are holes in walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "published/make_flow.h"
#include "schemes/open_ends.h"

namespace tailwater {
namespace {

WallTable line(std::vector<Coordinates> points) {
  WallTable wall;
  wall.points = std::move(points);
  return wall;
}

/// A tank 1 m wide and 0.6 m deep with a slot of 0.4 m in its right wall.
CaseSpec tank_with_slot() {
  CaseSpec spec;
  spec.particles.spacing = end_spacing;
  spec.physics.gravity = {0.0, -g};
  spec.walls = {line({{0.0, 0.8}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.1}}), line({{1.0, 0.5}, {1.0, 0.8}})};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.0, 0.6};
  water.velocity = {0.0, 0.0};
  spec.fluid = {water};
  OutletTable slot;
  slot.from = {1.0, 0.1};
  slot.to = {1.0, 0.5};
  slot.direction = {1.0, 0.0};
  spec.outlets = {slot};
  return spec;
}

/// A jet falls below the slot while it leaves. All of it is removed near the slot, and counted.
TEST(Hole, AJetIntoAirIsCounted) {
  CaseSpec spec = tank_with_slot();
  spec.outlets[0].beyond = Beyond::air;
  Flow<2> flow = make_flow<2>(spec);
  ASSERT_TRUE(flow.walls.boundary.ducts.empty());
  const auto at_start = static_cast<std::int64_t>(count_fluid(flow));
  start(flow);
  while (flow.state.time < 0.8) {
    pass_and_step(flow);
    ASSERT_EQ(at_start, static_cast<std::int64_t>(count_fluid(flow)) + state_of_end(flow, 0).departed.particles);
  }
  EXPECT_GT(state_of_end(flow, 0).departed.particles, at_start / 10);
  remove_outflow(flow);
  const double farthest = 6.0 * end_spacing;  // from the slot, in all directions
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    const Vec<2>& x = flow.state.particles.position[i];
    if (!flow.state.particles.is_fluid(i)) continue;
    EXPECT_LE(x[0], 1.0 + farthest);
    EXPECT_GE(x[1], x[0] > 1.0 ? 0.1 - farthest : 0.0);
  }
}

/// Water as high as the level beyond a drowned slot rests: none of it moves faster than half a spacing of error in the
/// level would drive it through the slot, and the slot passes no more than its own column of particles.
TEST(Hole, WaterRestsBesideTheSameLevel) {
  CaseSpec spec = tank_with_slot();
  spec.outlets[0].level = 0.6;
  Flow<2> flow = make_flow<2>(spec);
  EXPECT_EQ(flow.walls.boundary.ducts.size(), 1u);
  start(flow);
  double fastest = 0.0;
  while (flow.state.time < 2.0) {
    pass_and_step(flow);
    fastest = std::max(fastest, measure(flow).largest_speed);
  }
  EXPECT_LT(fastest, 0.1 * std::sqrt(g * end_spacing));
  const OpenEndState& state = state_of_end(flow, 0);
  EXPECT_LE(std::abs(state.departed.volume - state.arrived.volume), end_spacing * 0.4);
}

/// Where the level beyond is lower the tank sinks to it, although the level stays above the top of the slot.
TEST(Hole, ATankSinksToTheLevelBeyond) {
  CaseSpec spec = tank_with_slot();
  spec.outlets[0].level = 0.55;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 6.0) pass_and_step(flow);
  double volume = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    const bool is_in_tank = flow.state.particles.position[i][0] < 1.0;
    if (flow.state.particles.is_fluid(i) && is_in_tank) volume += flow.state.particles.volume[i];
  }
  EXPECT_NEAR(volume / 1.0, 0.55, 0.5 * end_spacing);
}

}  // namespace
}  // namespace tailwater
