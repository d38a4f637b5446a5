// Open ends. Taking out and counting is exact. What stands before one behaves as if the channel went on, up to the
// resolution of the level, which is known no better than half a spacing.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

constexpr double dx = 0.05;

template <class D>
class OutletTest : public testing::Test {};
TYPED_TEST_SUITE(OutletTest, Dimensions);

/// The tank of tank_case with its end at high x open.
template <int Dim>
CaseSpec open_tank(double width, double depth) {
  CaseSpec spec = tank_case<Dim>(dx, width, depth);
  spec.walls[0].open.emplace_back("+x");
  OutletTable end;
  end.from = Coordinates(Dim, 0.0);
  end.from[0] = width;
  end.to = spec.walls[0].max;
  end.direction = Coordinates(Dim, 0.0);
  end.direction[0] = 1.0;
  spec.outlets = {end};
  return spec;
}

template <int Dim>
std::multiset<std::int64_t> fluid_ids(const Particles<Dim>& particles) {
  std::multiset<std::int64_t> ids;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (particles.is_fluid(i)) ids.insert(particles.id[i]);
  }
  return ids;
}

/// Without gravity a plug that glides along the walls feels nothing: it leaves as it came, column by column, and the
/// empty case goes on.
TYPED_TEST(OutletTest, APlugLeavesUnchangedAndIsCounted) {
  constexpr int Dim = TypeParam::value;
  constexpr double speed = 2.0;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = open_tank<Dim>(0.4, 0.2);
    spec.walls[0].open.emplace_back("-x");
    spec.physics.gravity = Coordinates(Dim, 0.0);
    spec.scheme.integrator = integrator;
    spec.scheme.shifting = ShiftingKind::none;  // it would round the plug's ends off
    spec.scheme.density_relaxation = 0.0;       // they have too few neighbours
    spec.scheme.length = 0.2;
    spec.fluid[0].velocity.assign(Dim, 0.0);
    spec.fluid[0].velocity[0] = speed;
    Flow<Dim> flow(spec);
    const auto ids_at_start = fluid_ids(flow.state.particles);
    const double energy_at_start = measure(flow).kinetic_energy;
    while (flow.state.time < 0.4 / speed + 2.0 * dx / speed) {
      let_go(flow);
      const auto before = fluid_ids(flow.state.particles);
      step(flow);
      const Departed& departed = flow.state.open_ends[0].departed;
      ASSERT_EQ(fluid_ids(flow.state.particles), before) << "a step takes nothing out";
      ASSERT_EQ(before.size() + static_cast<std::size_t>(departed.particles), ids_at_start.size());
      ASSERT_TRUE(std::includes(ids_at_start.begin(), ids_at_start.end(), before.begin(), before.end()));
      ASSERT_NEAR(departed.volume, static_cast<double>(departed.particles) * power<Dim>(dx), 1e-12);
    }
    EXPECT_EQ(fluid_ids(flow.state.particles).size(), 0u);
    EXPECT_NEAR(flow.state.open_ends[0].departed.energy / energy_at_start, 1.0, 1e-9);
    const FlowMeasures measures = measure(flow);
    EXPECT_EQ(measures.kinetic_energy, 0.0);
    EXPECT_EQ(measures.departed.particles, static_cast<std::int64_t>(ids_at_start.size()));
  }
}

/// Still water stays, but for what an error of half a spacing in the level beyond drives: u = (g/c) dx/2. Over a brink
/// it would leave at 8/27 sqrt(g h) h, six times as much. A column leaves at a time.
TYPED_TEST(OutletTest, StillWaterIsNotDrawnDown) {
  constexpr int Dim = TypeParam::value;
  const double width = Dim == 2 ? 1.0 : 0.4;
  const double depth = Dim == 2 ? 0.5 : 0.2;
  const double breadth = Dim == 2 ? 1.0 : width;
  const double celerity = std::sqrt(g * depth);
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = open_tank<Dim>(width, depth);
    spec.scheme.integrator = integrator;
    Flow<Dim> flow(spec);
    start(flow);
    while (flow.state.time < 2.0 * width / celerity) {
      let_go(flow);
      step(flow);
    }
    const double speed = g / celerity * 0.5 * dx;
    EXPECT_LE(flow.state.open_ends[0].departed.volume, (speed * flow.state.time + dx) * depth * breadth + 1e-12);
  }
}

/// A pressing stretch of water keeps no memory of how it is oriented: the mirrored channel does the same, mirrored.
TEST(Outlet, LeftIsRightMirrored) {
  CaseSpec right = open_tank<2>(0.8, 0.4);
  right.fluid[0].velocity = {1.0, 0.0};
  CaseSpec left = right;
  left.walls[0].open = {"+y", "-x"};
  left.outlets[0].from = {0.0, 0.0};
  left.outlets[0].to = {0.0, 0.8};
  left.outlets[0].direction = {-1.0, 0.0};
  left.fluid[0].velocity = {-1.0, 0.0};
  Flow<2> flow_right(right);
  Flow<2> flow_left(left);
  for (int n = 0; n < 20; ++n) {
    for (Flow<2>* flow : {&flow_right, &flow_left}) {
      let_go(*flow);
      advance(*flow, 0.002);
    }
  }
  EXPECT_GT(flow_right.state.open_ends[0].departed.particles, 0);
  EXPECT_EQ(flow_right.state.open_ends[0].departed.particles, flow_left.state.open_ends[0].departed.particles);
  // As near as the solver's tolerance of 1e-4 leaves them.
  EXPECT_NEAR(measure(flow_right).kinetic_energy / measure(flow_left).kinetic_energy, 1.0, 1e-2);
}

/// A level that comes by is that of a channel that goes on: the pressure in the end stretch is hydrostatic below it.
TEST(Outlet, EndStretchIsHydrostatic) {
  CaseSpec spec = open_tank<2>(1.0, 0.5);
  spec.pressure_solver.tolerance = 1e-12;
  Flow<2> flow(spec);
  start(flow);
  int leaving = 0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.is_leaving(i)) continue;
    ++leaving;
    EXPECT_NEAR(flow.state.particles.pressure[i], flow.setup.density * g * (0.5 - flow.state.particles.position[i][1]),
                1e-6);
  }
  EXPECT_EQ(leaving, 4 * 10) << "the support and a spacing, in the whole depth";
}

/// Gravity along the normal presses on nothing: water falls through a hole in the floor as in air.
TEST(Outlet, HoleInTheFloor) {
  CaseSpec spec = open_tank<2>(0.4, 0.4);
  spec.walls[0].open = {"+y", "-y"};
  spec.outlets[0].from = {0.0, 0.0};
  spec.outlets[0].to = {0.4, 0.0};
  spec.outlets[0].direction = {0.0, -1.0};
  Flow<2> flow(spec);
  const std::size_t at_start = fluid_ids(flow.state.particles).size();
  start(flow);
  while (flow.state.time < 0.2) {
    let_go(flow);
    step(flow);
  }
  // Nothing holds it: what stood below g t^2/2, less a spacing and half, has fallen out.
  const double fallen = 0.5 * g * flow.state.time * flow.state.time;
  EXPECT_GE(flow.state.open_ends[0].departed.volume, 0.5 * 0.4 * (fallen - 1.5 * dx));
  EXPECT_LE(flow.state.open_ends[0].departed.volume, 0.4 * (fallen + 1.5 * dx));
  EXPECT_EQ(
      fluid_ids(flow.state.particles).size() + static_cast<std::size_t>(flow.state.open_ends[0].departed.particles),
      at_start);
}

}  // namespace
}  // namespace tailwater
