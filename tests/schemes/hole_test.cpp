// Openings that are holes in walls.
#include <gtest/gtest.h>

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
  CaseSpec spec = free_case(end_spacing);
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

}  // namespace
}  // namespace tailwater
