// The volume of pockets in a tank, and the effect of water particles on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "air/enclosed_air.h"
#include "flow/stages.h"
#include "neighbours/neighbourhood.h"
#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace volume_test {
namespace {

constexpr double dx = 0.05;

template <class D>
class PocketVolume : public testing::Test {};
TYPED_TEST_SUITE(PocketVolume, Dimensions);

/// A closed tank.
template <int Dim>
CaseSpec closed_tank(double width, double depth) {
  CaseSpec spec = tank_case<Dim>(dx, width, depth);
  spec.walls[0].open.clear();
  spec.air.pockets = AirPockets::adiabatic;
  return spec;
}

/// Keeps the water for which the condition holds.
template <int Dim, class Condition>
void keep_water(Flow<Dim>& flow, Condition&& condition) {
  const std::vector<std::size_t> kept = indices_where(flow.state.particles.owned, [&](std::size_t i) {
    return !flow.state.particles.is_fluid(i) || condition(flow.state.particles.position[i]);
  });
  flow.neighbourhood->keep(flow.state.particles, std::vector<std::int32_t>(kept.begin(), kept.end()));
}

// Cubes of edge dx around the particles fill the space of the water without a gap, so the rest of the tank is the
// volume of the pocket to rounding. If the rows are not dx apart, the cubes leave gaps or overlap: at the water surface
// the volume is then off by the difference, for up to one row.
TYPED_TEST(PocketVolume, IsWhatALatticeLeavesOfTheTank) {
  constexpr int Dim = TypeParam::value;
  for (const double depth : {0.3, 0.33}) {  // a whole number of dx, and another depth
    CaseSpec spec = closed_tank<Dim>(0.6, depth);
    Flow<Dim> flow = make_flow<Dim>(spec);
    air_of(flow).begin_step(flow, 0.0);
    ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
    const double tank = std::pow(0.6, Dim - 1) * 2.0 * depth;
    const double water = sum_over(flow.state.particles.owned, 0.0, [&](std::size_t i) {
      return flow.state.particles.is_fluid(i) ? flow.state.particles.volume[i] : 0.0;
    });
    const double rows = std::round(depth / dx);
    const double bound = std::abs(depth / rows - dx) * std::pow(0.6, Dim - 1) + 1e-9;
    EXPECT_NEAR(air_of(flow).state.pockets[0].volume, tank - water, bound) << depth;
  }
}

TYPED_TEST(PocketVolume, OfABubbleIsThatOfTheWaterThatIsMissing) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = closed_tank<Dim>(0.8, 0.4);
  spec.fluid[0].max[Dim - 1] = 0.8;
  Flow<Dim> flow = make_flow<Dim>(spec);
  const std::size_t all = count_fluid(flow);
  const Vec<Dim> centre = Vec<Dim>::Constant(0.39);
  keep_water(flow, [&](const Vec<Dim>& x) { return (x - centre).norm() > 0.16; });
  air_of(flow).begin_step(flow, 0.0);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
  const double missing = static_cast<double>(all - count_fluid(flow)) * std::pow(dx, Dim);
  EXPECT_NEAR(air_of(flow).state.pockets[0].volume, missing, 1e-9);
}

// Where water is not a lattice, the row at the surface matters: each particle is off at random by part of its volume,
// and the average over many is right. The test removes one particle in twelve at random.
TYPED_TEST(PocketVolume, IsRightInTheMeanBesideDisorderedWater) {
  constexpr int Dim = TypeParam::value;
  double error = 0.0;
  double squares = 0.0;
  constexpr int trials = 8;
  for (int seed = 1; seed <= trials; ++seed) {
    CaseSpec spec = closed_tank<Dim>(0.8, 0.4);
    spec.fluid[0].max[Dim - 1] = 0.8;
    spec.particles.jitter = 0.3;
    spec.particles.seed = seed;
    Flow<Dim> flow = make_flow<Dim>(spec);
    const std::size_t all = count_fluid(flow);
    keep_water(flow, [](const Vec<Dim>& x) { return (x - Vec<Dim>::Constant(0.39)).norm() > 0.16; });
    air_of(flow).begin_step(flow, 0.0);
    ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
    const double missing = static_cast<double>(all - count_fluid(flow)) * std::pow(dx, Dim);
    const double off = air_of(flow).state.pockets[0].volume / missing - 1.0;
    error += off / trials;
    squares += off * off / trials;
  }
  EXPECT_LT(std::sqrt(squares), 0.05);
  EXPECT_LT(std::abs(error), 3.0 * std::sqrt(squares / trials) + 1e-3);
}

TYPED_TEST(PocketVolume, OpenTankHasNone) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(dx, 0.6, 0.3);
  spec.air.pockets = AirPockets::adiabatic;
  Flow<Dim> flow = make_flow<Dim>(spec);
  air_of(flow).begin_step(flow, 0.0);
  EXPECT_TRUE(air_of(flow).state.pockets.empty());
}

// The interior of a block that stands in the water is not air.
TEST(PocketVolumeOfBlock, InsideOfABlockIsNone) {
  CaseSpec spec = tank_case<2>(dx, 1.6, 0.8);
  spec.air.pockets = AirPockets::adiabatic;
  WallTable block;
  block.shape = WallShape::box;
  block.min = {0.4, 0.2};
  block.max = {1.2, 0.7};
  block.fluid_side = FluidSide::outside;
  spec.walls.push_back(block);
  Flow<2> flow = make_flow<2>(spec);
  air_of(flow).begin_step(flow, 0.0);
  EXPECT_TRUE(air_of(flow).state.pockets.empty());
}

// The cube of a particle behind a wall has no volume in front of the wall, and the cells beside it belong to the
// pocket.
TEST(PocketVolumeOfBlock, WaterBehindAWallTakesNothing) {
  CaseSpec spec = closed_tank<2>(0.75, 0.375);
  spec.particles.spacing = 0.0625;  // edges of cells are whole numbers
  Flow<2> flow = make_flow<2>(spec);
  air_of(flow).begin_step(flow, 0.0);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 1u);
  const double volume = air_of(flow).state.pockets[0].volume;
  Flow<2> leaky = make_flow<2>(spec);
  leaky.state.particles.position[0] = Vec<2>(-0.03125, 0.5625);
  air_of(leaky).begin_step(leaky, 0.0);
  ASSERT_EQ(air_of(leaky).state.pockets.size(), 1u);
  EXPECT_NEAR(air_of(leaky).state.pockets[0].volume, volume, 1e-12);
}

// Air cannot pass a plate, which divides a closed tank into two pockets.
TEST(PocketVolumeOfPlate, PlateParts) {
  CaseSpec spec = closed_tank<2>(1.0, 0.4);
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.points = {{0.5, 0.2}, {0.5, 0.8}};
  spec.walls.push_back(plate);
  Flow<2> flow = make_flow<2>(spec);
  air_of(flow).begin_step(flow, 0.0);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 2u);
  for (const AirPocket& pocket : air_of(flow).state.pockets) EXPECT_NEAR(pocket.volume, 0.2, 1e-6);
}

// Water on the other side of a plate does not see a pocket, which would grow by the motion of that water.
TEST(PocketVolumeOfPlate, HidesWaterBehindIt) {
  CaseSpec spec = closed_tank<2>(1.0, 0.4);
  spec.fluid[0].max[1] = 0.6;
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.points = {{0.5, 0.2}, {0.5, 0.8}};
  spec.walls.push_back(plate);
  Flow<2> flow = make_flow<2>(spec);
  keep_water(flow, [](const Vec<2>& x) { return x[0] < 0.5 || x[1] < 0.3; });
  EnclosedAir<2>& air = air_of(flow);
  air.begin_step(flow, 0.0);
  ASSERT_EQ(air.state.pockets.size(), 2u);
  const int right = air.state.pockets[0].volume > air.state.pockets[1].volume ? 0 : 1;
  EXPECT_NEAR(air.state.pockets[right].volume, 0.5 * 0.5, 1e-6);
  EXPECT_NEAR(air.state.pockets[1 - right].volume, 0.5 * 0.2, 1e-6);
  const auto sees = [&](const Vec<2>& x, int pocket) {
    const std::vector<PocketShare> shares = air.watch.shares_at(flow.walls.boundary, x);
    return std::ranges::any_of(shares, [&](const PocketShare& share) { return share.pocket == pocket; });
  };
  EXPECT_FALSE(sees({0.475, 0.425}, right));
  EXPECT_TRUE(sees({0.475, 0.425}, 1 - right));
  EXPECT_TRUE(sees({0.525, 0.275}, right));
}

}  // namespace
}  // namespace volume_test
}  // namespace tailwater
