// Water under tension: a siphon over a crown above its levels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "air/pulled_walls.h"
#include "air/voids_under_tension.h"
#include "schemes/cases.h"

namespace tailwater {
namespace {

constexpr double level = 0.4;
constexpr double roof = 0.7;

/// Two tanks with the same level, joined by a full tube 6 dx wide whose roof is 0.3 m above them.
CaseSpec siphon(double tension) {
  CaseSpec spec;
  spec.particles.spacing = 1.0 / 60.0;
  spec.physics.tension = tension;
  WallTable ground, bonnet;
  ground.name = "ground";
  ground.points = {{-0.4, 0.8}, {-0.4, 0.0}, {0.1, 0.0}, {0.1, 0.6}, {0.3, 0.6}, {0.3, 0.0}, {0.8, 0.0}, {0.8, 0.8}};
  bonnet.name = "bonnet";
  bonnet.shape = WallShape::plate;
  bonnet.points = {{0.0, 0.2}, {0.0, roof}, {0.4, roof}, {0.4, 0.2}};
  spec.walls = {ground, bonnet};
  const auto add = [&](const Coordinates& min, const Coordinates& max) {
    FluidTable block;
    block.min = min;
    block.max = max;
    spec.fluid.push_back(block);
  };
  add({-0.4, 0.0}, {0.0, level});
  add({0.0, 0.0}, {0.1, roof});
  add({0.1, 0.6}, {0.3, roof});
  add({0.3, 0.0}, {0.4, roof});
  add({0.4, 0.0}, {0.8, level});
  return spec;
}

/// The largest speed of the water that hangs above the levels, where no surface is near.
double largest_speed_of(const Flow<2>& flow) {
  const Particles<2>& particles = flow.state.particles;
  double largest = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i) || particles.position[i][1] < level + 0.1) continue;
    largest = std::max(largest, particles.velocity[i].norm());
  }
  return largest;
}

/// In free fall the water below the roof would be at 1.5 m/s after the time of the test.
TEST(Siphon, RestsWithTension) {
  Flow<2> flow = make_flow<2>(siphon(5e4));
  start(flow);
  while (flow.state.time < 0.15) step(flow);
  EXPECT_LT(largest_speed_of(flow), 0.02);
  // The water below the roof has the hydrostatic pressure below that of the atmosphere.
  const Particles<2>& particles = flow.state.particles;
  const double scale = flow.setup.liquid.density * g * (roof - level);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const double height = particles.position[i][1];
    if (!particles.is_fluid(i) || height < roof - 0.05) continue;
    EXPECT_NEAR(particles.pressure[i], -flow.setup.liquid.density * g * (height - level), 0.02 * scale);
  }
}

/// With less tension than the roof needs the water leaves it. The space below the roof has no air, and grows.
TEST(Siphon, ReportsAVoidThatNoAirCanReach) {
  for (const double tension : {1e3, 5e4}) {
    Flow<2> flow = make_flow<2>(siphon(tension));
    start(flow);
    ASSERT_TRUE(has_part<VoidsUnderTension<2>>(flow));
    const auto& voids = dynamic_cast<const VoidsUnderTension<2>&>(
        **std::ranges::find_if(flow.parts, [](const auto& part) { return part->name() == "voids_under_tension"; }));
    const double end = tension < 5e4 ? 0.4 : 0.15;
    while (flow.state.time < end && voids.find_grown() == nullptr) step(flow);
    EXPECT_EQ(voids.find_grown() != nullptr, tension < 5e4) << tension;
  }
}

/// A full channel with a roof that empties through its open end. The front of the air moves to the left, and the roof
/// would pull the water beyond it (Benjamin 1968). Without tension the water leaves the whole roof, 10 to 20 % too
/// fast.
TEST(ClosedChannelThatEmpties, ReportsThatItsRoofWouldPull) {
  for (const double tension : {0.0, 5e3}) {
    CaseSpec spec = testing_cases::empty_case(0.01);
    spec.physics.tension = tension;
    spec.walls = {testing_cases::polyline({{0.6, 0.1}, {0.0, 0.1}, {0.0, 0.0}, {1.6, 0.0}, {1.6, 0.3}})};
    spec.fluid = {testing_cases::box_fluid({0.0, 0.0}, {0.6, 0.1})};
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    while (flow.state.time < 0.4) step(flow);
    const auto part = std::ranges::find_if(flow.parts, [](const auto& p) { return p->name() == "pulled_walls"; });
    ASSERT_NE(part, flow.parts.end());
    const Pull<2> pull = dynamic_cast<const PulledWalls<2>&>(**part).find(flow);
    if (tension > 0.0) {
      EXPECT_LT(pull.area, 0.05) << "beside the edge of the roof";
    } else {
      EXPECT_GT(pull.area, 0.2);
      EXPECT_NEAR(pull.where[1], 0.1, 0.04) << "roof";
      EXPECT_GT(pull.tension, 200.0);
      EXPECT_LT(pull.tension, 1000.0 * g * 0.1) << "the weight of the water";
    }
  }
}

TEST(Siphon, DrainsWithoutTension) {
  Flow<2> flow = make_flow<2>(siphon(0.0));
  start(flow);
  while (flow.state.time < 0.1) step(flow);
  EXPECT_GT(largest_speed_of(flow), 0.2);
}

}  // namespace
}  // namespace tailwater
