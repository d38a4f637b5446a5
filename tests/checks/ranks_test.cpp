// The initial water and the checks of the shapes on several ranks: together exactly the results of one rank.
#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "checks/check.h"
#include "geometry/cases.h"
#include "parallel/at_start.h"
#include "sampling/fluid_particles.h"
#include "support/circle.h"

namespace tailwater {
namespace {

using namespace testing_cases;

/// Cases whose parts meet within rows, blocks and cut cells.
std::vector<CaseSpec> cases() {
  std::vector<CaseSpec> cases;
  CaseSpec boxes = empty_case(0.05);
  boxes.particles.jitter = 0.2;
  boxes.walls = {box_wall({0, 0}, {2, 1}, {"+y"})};
  boxes.fluid = {box_fluid({0, 0}, {0.7, 0.5}), box_fluid({0.7, 0}, {2, 0.3})};
  cases.push_back(boxes);
  CaseSpec slope = empty_case(0.05);
  slope.walls = {polyline({{0, 1}, {0, 0}, {1, 0.37}, {1, 1}})};
  slope.fluid = {polygon_fluid({{0, 0}, {1, 0.37}, {1, 0.8}, {0, 0.8}})};
  cases.push_back(slope);
  CaseSpec fill = slope;
  fill.fluid[0] = {};
  fill.fluid[0].shape = BlockShape::fill;
  fill.fluid[0].seed = {0.5, 0.5};
  fill.fluid[0].level = 0.8;
  cases.push_back(fill);
  CaseSpec round = boxes;
  round.walls.push_back(polygon(circle(24, 0.21, {1.02, 0.33}), FluidSide::outside));
  cases.push_back(round);
  slope.scheme.formulation = Formulation::published;
  cases.push_back(slope);
  CaseSpec wrong = boxes;  // overlapping, behind a wall, and leaking
  wrong.fluid[1].min = {0.5, 0};
  wrong.fluid[1].max = {2.3, 0.3};
  cases.push_back(wrong);
  return cases;
}

std::vector<std::string> messages(const Findings& findings) {
  std::vector<std::string> messages;
  for (const Finding& finding : findings) messages.push_back(finding.message());
  return messages;
}

TEST(WaterOfRanks, IsTogetherThatOfOne) {
  const Communicator world = Communicator::world();
  for (const CaseSpec& spec : cases()) {
    const Boundary<2> boundary = make_boundary<2>(spec);
    const FluidParticles<2> alone = make_fluid_particles(spec, boundary);
    constexpr std::int64_t others = 7;
    const FluidParticles<2> own = make_fluid_particles(spec, boundary, world, others);
    const auto count = static_cast<std::int64_t>(alone.position.size());
    ASSERT_GT(count, 100);
    EXPECT_EQ(own.all, count);
    EXPECT_LE(static_cast<std::int64_t>(own.position.size()), (count + others) / world.size() + 1);
    EXPECT_EQ(own.first, world.sum_before(static_cast<std::int64_t>(own.position.size())));
    EXPECT_EQ(gather_on_all(world, own.position), alone.position);
    EXPECT_EQ(gather_on_all(world, own.velocity), alone.velocity);
    EXPECT_EQ(gather_on_all(world, own.volume), alone.volume);
    EXPECT_EQ(gather_on_all(world, own.block), alone.block);
    EXPECT_EQ(own.box().min(), alone.box().min());
    EXPECT_EQ(own.box().max(), alone.box().max());
    EXPECT_EQ(own.extent_along(Vec<2>(0.6, 0.8)), alone.extent_along(Vec<2>(0.6, 0.8)));
  }
}

TEST(WaterOfRanks, IsCheckedAsThatOfOne) {
  const Communicator world = Communicator::world();
  std::size_t found = 0;
  for (const CaseSpec& spec : cases()) {
    const Boundary<2> boundary = make_boundary<2>(spec);
    const auto expected = messages(check_geometry(spec, boundary, make_fluid_particles(spec, boundary)));
    EXPECT_EQ(messages(check_geometry(spec, boundary, make_fluid_particles(spec, boundary, world))), expected);
    found += expected.size();
  }
  EXPECT_GE(found, 3u) << "the wrong case is wrong in three ways";
}

}  // namespace
}  // namespace tailwater
