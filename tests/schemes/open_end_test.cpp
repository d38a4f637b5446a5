// Open ends. Outflow, inflow and counts are exact. Water before an outlet behaves as if the channel continued, up to
// the resolution of the level, which is half a spacing. An inlet delivers the prescribed discharge to one particle.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>

#include "geometry/cases.h"
#include "parts/section_counters.h"
#include "published/make_flow.h"
#include "schemes/open_ends.h"
#include "support/dimensions.h"

namespace tailwater {
namespace open_end_test {

constexpr double dx = end_spacing;

template <class D>
class OpenEndTest : public testing::Test {};
TYPED_TEST_SUITE(OpenEndTest, Dimensions);

/// A wall particle counts as wet from a kernel sum of 1e-6 W(0) on (wet_walls.cpp), where 1 - r/R = 0.02. Its
/// contribution to a divergence is there dx^2 |W'| = 1.6e-5/dx, and a plug that slips along the wall changes by this
/// amount as such particles become wet and dry. Steps of 0.25 or 0.5 dx pass no wall particle at such a distance.
constexpr double unfelt = 1.6e-5;

template <int Dim>
std::multiset<std::int64_t> fluid_ids(const Particles<Dim>& particles) {
  std::multiset<std::int64_t> ids;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (particles.is_fluid(i)) ids.insert(particles.id[i]);
  }
  return ids;
}

/// Without gravity no force acts on a plug that slips along the walls: it leaves unchanged, column by column, and the
/// empty case continues.
TYPED_TEST(OpenEndTest, APlugLeavesUnchangedAndIsCounted) {
  constexpr int Dim = TypeParam::value;
  constexpr double speed = 2.0;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = open_tank<Dim>(0.4, 0.2);
    spec.walls[0].open.emplace_back("-x");
    spec.physics.gravity = Coordinates(Dim, 0.0);
    spec.scheme.integrator = integrator;
    spec.study.shifting = 0.0;            // shifting would round the ends of the plug
    spec.study.density_relaxation = 0.0;  // particles at the ends have too few neighbours
    spec.study.length = 0.2;
    spec.fluid[0].velocity.assign(Dim, 0.0);
    spec.fluid[0].velocity[0] = speed;
    Flow<Dim> flow = make_flow<Dim>(spec);
    const auto ids_at_start = fluid_ids(flow.state.particles);
    const double energy_at_start = measure(flow).kinetic_energy;
    const double duct = flow.walls.boundary.ducts[0].length;
    while (flow.state.time < (0.4 + duct + 2.0 * dx) / speed) {
      remove_outflow(flow);
      const auto before = fluid_ids(flow.state.particles);
      step(flow);
      const WaterAmount& departed = state_of_end(flow, 0).departed;
      ASSERT_EQ(fluid_ids(flow.state.particles), before) << "a step takes nothing out";
      ASSERT_EQ(before.size() + static_cast<std::size_t>(departed.particles), ids_at_start.size());
      ASSERT_TRUE(std::includes(ids_at_start.begin(), ids_at_start.end(), before.begin(), before.end()));
      ASSERT_NEAR(departed.volume, static_cast<double>(departed.particles) * power<Dim>(dx), 1e-12);
    }
    EXPECT_EQ(fluid_ids(flow.state.particles).size(), 0u);
    EXPECT_NEAR(state_of_end(flow, 0).departed.energy / energy_at_start, 1.0, unfelt);
    const FlowMeasures measures = measure(flow);
    EXPECT_EQ(measures.kinetic_energy, 0.0);
    EXPECT_EQ(measures.departed.particles, static_cast<std::int64_t>(ids_at_start.size()));
  }
}

/// Still water stays, except for the flow that an error of half a spacing in the level beyond causes: u = (g/c) dx/2.
/// Over a brink it would leave at 8/27 sqrt(g h) h, six times as much. A whole column leaves at once.
TYPED_TEST(OpenEndTest, StillWaterIsNotDrawnDown) {
  constexpr int Dim = TypeParam::value;
  const double width = Dim == 2 ? 1.0 : 0.4;
  const double depth = Dim == 2 ? 0.5 : 0.2;
  const double breadth = Dim == 2 ? 1.0 : width;
  const double celerity = std::sqrt(g * depth);
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = open_tank<Dim>(width, depth);
    spec.scheme.integrator = integrator;
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    while (flow.state.time < 2.0 * width / celerity) {
      remove_outflow(flow);
      step(flow);
    }
    const double speed = g / celerity * 0.5 * dx;
    EXPECT_LE(state_of_end(flow, 0).departed.volume, (speed * flow.state.time + dx) * depth * breadth + 1e-12);
  }
}

/// Water that flows towards an outlet behaves equally in both directions: the mirrored channel has the mirrored flow.
TEST(Outlet, LeftIsRightMirrored) {
  CaseSpec right = open_tank<2>(0.8, 0.4);
  right.fluid[0].velocity = {1.0, 0.0};
  CaseSpec left = right;
  left.walls[0].open = {"+y", "-x"};
  left.outlets[0].from = {0.0, 0.0};
  left.outlets[0].to = {0.0, 0.8};
  left.outlets[0].direction = {-1.0, 0.0};
  left.fluid[0].velocity = {-1.0, 0.0};
  Flow<2> flow_right = make_flow<2>(right);
  Flow<2> flow_left = make_flow<2>(left);
  for (int n = 0; n < 20; ++n) {
    for (Flow<2>* flow : {&flow_right, &flow_left}) {
      remove_outflow(*flow);
      advance(*flow, 0.002);
    }
  }
  EXPECT_GT(state_of_end(flow_right, 0).departed.particles, 0);
  EXPECT_EQ(state_of_end(flow_right, 0).departed.particles, state_of_end(flow_left, 0).departed.particles);
  // As near as the solver's tolerance of 1e-4 allows.
  EXPECT_NEAR(measure(flow_right).kinetic_energy / measure(flow_left).kinetic_energy, 1.0, 1e-2);
}

/// The level of an outlet without a level is that of a continuing channel: the pressure in the buffer zone is
/// hydrostatic below it.
TEST(Outlet, EndStretchIsHydrostatic) {
  CaseSpec spec = open_tank<2>(1.0, 0.5);
  spec.pressure_solver.tolerance = 1e-12;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  int leaving = 0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!is_claimed(flow.role[i])) continue;
    ++leaving;
    EXPECT_NEAR(flow.state.particles.pressure[i],
                flow.setup.liquid.density * g * (0.5 - flow.state.particles.position[i][1]), 1e-6);
  }
  EXPECT_EQ(leaving, 4 * 10) << "the support and a spacing, in the whole depth";
}

/// Gravity along the normal causes no pressure: water falls through a hole in the floor as in air.
TEST(Outlet, HoleInTheFloor) {
  CaseSpec spec = open_tank<2>(0.4, 0.4);
  spec.walls[0].open = {"+y", "-y"};
  spec.outlets[0].from = {0.0, 0.0};
  spec.outlets[0].to = {0.4, 0.0};
  spec.outlets[0].direction = {0.0, -1.0};
  Flow<2> flow = make_flow<2>(spec);
  const std::size_t at_start = fluid_ids(flow.state.particles).size();
  start(flow);
  while (flow.state.time < 0.2) {
    remove_outflow(flow);
    step(flow);
  }
  // No force holds the water: the part that was below g t^2/2, less one spacing and a half, has fallen out.
  const double fallen = 0.5 * g * flow.state.time * flow.state.time;
  EXPECT_GE(state_of_end(flow, 0).departed.volume, 0.5 * 0.4 * (fallen - 1.5 * dx));
  EXPECT_LE(state_of_end(flow, 0).departed.volume, 0.4 * (fallen + 1.5 * dx));
  EXPECT_EQ(fluid_ids(flow.state.particles).size() + static_cast<std::size_t>(state_of_end(flow, 0).departed.particles),
            at_start);
}

/// Without gravity no force acts on water that enters at a uniform speed: it stays on the lattice of its entrance, to
/// round-off, and every particle is counted once.
TYPED_TEST(OpenEndTest, APlugEntersOnALatticeAndIsCounted) {
  constexpr int Dim = TypeParam::value;
  constexpr double speed = 2.0;
  const double height = 0.4;  // of the opening: 8 rows
  CaseSpec spec = channel<Dim>(1.0, 0.2);
  spec.walls[0].max.back() = spec.inlets[0].to.back() = spec.outlets[0].to.back() = height;
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.study.shifting = 0.0;
  spec.study.density_relaxation = 0.0;
  spec.study.length = 0.2;
  spec.fluid.clear();
  spec.inlets[0].velocity = speed;
  const double breadth = 1.0;  // m; in 3D as broad as wide
  Flow<Dim> flow = make_flow<Dim>(spec);
  start(flow);
  std::size_t before = 0;
  while (flow.state.time < 0.3) {
    pass_and_step(flow);
    const std::size_t now = count_fluid(flow);
    ASSERT_GE(now, before);
    before = now;
    const WaterAmount arrived = arrived_at(flow, 0);
    ASSERT_EQ(static_cast<std::size_t>(arrived.particles), now);
    ASSERT_NEAR(arrived.volume, static_cast<double>(now) * power<Dim>(dx), 1e-12);
    const double asked = speed * flow.state.time * height * breadth;
    // The first column stands dx/2 behind the opening, and the next enters after another dx/2: the number of columns is
    // the integer part of 3/2 + way/dx.
    ASSERT_LE(arrived.volume - asked, 1.5 * dx * height * breadth + 1e-12);
    ASSERT_GE(arrived.volume - asked, -dx * height * breadth - 1e-12) << "a column enters between two steps";
  }
  ASSERT_GT(before, 0u);
  EXPECT_EQ(fluid_ids(flow.state.particles).size(), before);
  const std::multiset<std::int64_t> ids = fluid_ids(flow.state.particles);
  EXPECT_EQ(std::set<std::int64_t>(ids.begin(), ids.end()).size(), before) << "ids are unique";
  const Particles<Dim>& particles = flow.state.particles;
  const double way = speed * flow.state.time / dx;
  std::optional<double> first;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const Vec<Dim>& x = particles.position[i];
    if (!first) first = x[0];
    const double columns = (x[0] - *first) / dx;
    ASSERT_NEAR(columns, std::round(columns), way * unfelt);
    const double rows = x[Dim - 1] / dx + 0.5;
    ASSERT_NEAR(rows, std::round(rows), way * unfelt);
    ASSERT_NEAR(particles.velocity[i][0], speed, speed * unfelt);
  }
}

/// Uniform flow through a channel. The inflow is the prescribed one to a layer. The counts of both ends and of the
/// water inside balance to the particle. The volume that passes a section in the middle differs only by the water
/// between.
TYPED_TEST(OpenEndTest, WhatEntersIsWhatIsAskedFor) {
  constexpr int Dim = TypeParam::value;
  const double width = Dim == 2 ? 1.5 : 0.7;
  const double depth = Dim == 2 ? 0.4 : 0.2;
  const double breadth = Dim == 2 ? 1.0 : width;
  const double speed = 0.4 * std::sqrt(g * depth);
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = channel<Dim>(width, depth);
    spec.scheme.integrator = integrator;
    spec.fluid[0].velocity.assign(Dim, 0.0);
    spec.fluid[0].velocity[0] = speed;
    spec.inlets[0].discharge = speed * depth * breadth;
    spec.outlets[0].level = depth;
    ProbeTable section;
    section.name = "middle";
    section.type = ProbeType::discharge;
    section.from = spec.outlets[0].from;
    section.to = spec.outlets[0].to;
    section.from[0] = section.to[0] = 0.5 * width;
    section.direction = spec.outlets[0].direction;
    spec.probes = {section};
    Flow<Dim> flow = make_flow<Dim>(spec);
    const double volume_at_start = static_cast<double>(count_fluid(flow)) * power<Dim>(dx);
    const auto at_start = static_cast<std::int64_t>(count_fluid(flow));
    start(flow);
    while (flow.state.time < 0.5 * width / speed) pass_and_step(flow);
    const WaterAmount arrived = arrived_at(flow, 0);
    const WaterAmount departed = state_of_end(flow, 1).departed;
    EXPECT_NEAR(arrived.volume, speed * depth * breadth * flow.state.time, dx * depth * breadth);
    const auto inside = static_cast<std::int64_t>(count_fluid(flow));
    EXPECT_EQ(at_start + arrived.particles + state_of_end(flow, 1).arrived.particles,
              inside + departed.particles + state_of_end(flow, 0).departed.particles);
    double before_section = 0.0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      const bool is_before = flow.state.particles.is_fluid(i) && flow.state.particles.position[i][0] <= 0.5 * width;
      if (is_before) before_section += flow.state.particles.volume[i];
    }
    const double passed = flow.template part<SectionCounters<Dim>>().volumes()[0];
    EXPECT_NEAR(0.5 * volume_at_start + arrived.volume, before_section + passed, 1e-9);
  }
}

/// A negative discharge takes water out through the inlet.
TEST(OpenEnd, AnInletThatIsReversedTakesWaterOut) {
  const double depth = 0.4;
  const double speed = 0.3;
  CaseSpec spec = channel<2>(1.5, depth);
  spec.fluid[0].velocity = {-speed, 0.0};
  spec.inlets[0].discharge = -speed * depth;
  spec.outlets[0].level = depth;
  Flow<2> flow = make_flow<2>(spec);
  const auto at_start = static_cast<std::int64_t>(count_fluid(flow));
  start(flow);
  while (flow.state.time < 1.0) pass_and_step(flow);
  const OpenEndState& inlet = state_of_end(flow, 0);
  const OpenEndState& outlet = state_of_end(flow, 1);
  EXPECT_NEAR(inlet.departed.volume, speed * depth * flow.state.time, dx * depth);
  EXPECT_EQ(inlet.arrived.particles, 0);
  EXPECT_GT(outlet.arrived.particles, 0) << "the tailwater comes back";
  EXPECT_EQ(at_start + outlet.arrived.particles,
            static_cast<std::int64_t>(count_fluid(flow)) + inlet.departed.particles + outlet.departed.particles);
}

/// The prescribed volume reaches the case, to one column of particles, though the water beyond the inlet becomes deeper
/// or shallower with the water inside.
TEST(OpenEnd, AnInletFillsAndEmptiesAPoolByItsDischarge) {
  const double length = 1.0;
  for (const double discharge : {0.1, -0.1}) {
    const double depth = discharge > 0.0 ? 0.4 : 0.7;
    CaseSpec spec = tank_case<2>(dx, length, depth);
    open_start(spec).discharge = discharge;
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    while (flow.state.time < 3.0) pass_and_step(flow);
    const Particles<2>& particles = flow.state.particles;
    double inside = 0.0;
    for (std::size_t i = 0; i < particles.owned; ++i) {
      if (particles.is_fluid(i) && particles.position[i][0] > 0.0) inside += particles.volume[i];
    }
    const double expected = length * depth + discharge * flow.state.time;
    EXPECT_NEAR(inside, expected, dx * expected / length) << discharge;
  }
}

/// A pump draws the prescribed volume to a row of particles, though four rows do not fill its opening exactly.
TEST(OpenEnd, APumpInTheFloorDrawsTheVolumeThatIsPrescribed) {
  using testing_cases::polyline;
  CaseSpec spec = testing_cases::empty_case(0.02);
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {0.4, 0.0}}), polyline({{0.48, 0.0}, {1.2, 0.0}, {1.2, 0.6}})};
  spec.fluid = {testing_cases::box_fluid({0.0, 0.0}, {1.2, 0.3})};
  InletTable pump;
  pump.name = "pump";
  pump.from = {0.4, 0.0};
  pump.to = {0.48, 0.0};
  pump.direction = {0.0, 1.0};
  pump.discharge = -0.05;
  spec.inlets = {pump};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 2.0) pass_and_step(flow);
  EXPECT_NEAR(state_of_end(flow, 0).departed.volume, 0.05 * flow.state.time, 0.02 * 0.08);
}

/// Water at rest between an inlet without discharge and a tailwater at its level stays at rest. Only the flow that an
/// error of half a spacing in the level causes is allowed.
TEST(OpenEnd, AChannelAtRestStaysAtRest) {
  const double depth = 0.4;
  CaseSpec spec = channel<2>(1.0, depth);
  spec.inlets[0].discharge = 0.0;
  spec.outlets[0].level = depth;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const double celerity = std::sqrt(g * depth);
  while (flow.state.time < 2.0 / celerity) pass_and_step(flow);
  const OpenEndState& outlet = state_of_end(flow, 1);
  const double bound = (g / celerity * 0.5 * dx * flow.state.time + dx) * depth;
  EXPECT_LE(std::abs(outlet.departed.volume - outlet.arrived.volume), bound);
  EXPECT_EQ(state_of_end(flow, 0).departed.particles + state_of_end(flow, 0).arrived.particles, 0);
  EXPECT_NEAR(state_of_end(flow, 0).depth, depth, 0.5 * dx);
}

/// Circulating water is neither lost nor created: at any time, the water inside and in the reserve equals the initial
/// water, in number and volume. A channel whose reserve is exhausted receives no more than has left it.
TYPED_TEST(OpenEndTest, WaterThatCirculatesIsTheSame) {
  constexpr int Dim = TypeParam::value;
  const double width = Dim == 2 ? 1.5 : 0.5;
  const double depth = Dim == 2 ? 0.4 : 0.2;
  const double breadth = Dim == 2 ? 1.0 : width;
  const double speed = 1.0;
  for (const double asked : {1.0, 1.3}) {
    CaseSpec spec = channel<Dim>(width, depth);
    spec.fluid[0].velocity.assign(Dim, 0.0);
    spec.fluid[0].velocity[0] = speed;
    spec.inlets[0].discharge = asked * depth * breadth;
    spec.outlets[0].name = "end";
    spec.outlets[0].level = depth;
    spec.inlets[0].water_from = "end";
    spec.inlets[0].reserve = asked == speed ? dx * depth * breadth : 0.0;  // a column, or nothing
    Flow<Dim> flow = make_flow<Dim>(spec);
    const auto at_start = static_cast<std::int64_t>(count_fluid(flow)) + sump_of(flow, 1).particles;
    ASSERT_EQ(sump_of(flow, 1).particles, std::lround(spec.inlets[0].reserve / power<Dim>(dx)));
    start(flow);
    while (flow.state.time < 0.4 * width / speed) {
      pass_and_step(flow);
      const WaterAmount sump = sump_of(flow, 1);
      ASSERT_GE(sump.particles, 0);
      ASSERT_EQ(static_cast<std::int64_t>(count_fluid(flow)) + sump.particles, at_start);
      double volume = sump.volume;
      for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
        if (flow.state.particles.is_fluid(i)) volume += flow.state.particles.volume[i];
      }
      ASSERT_NEAR(volume, static_cast<double>(at_start) * power<Dim>(dx), 1e-9);
    }
    const OpenEndState& inlet = state_of_end(flow, 0);
    EXPECT_GT(inlet.arrived.particles, 0);
    if (asked == speed) {
      EXPECT_EQ(inlet.short_steps, 0);
      EXPECT_NEAR(inlet.arrived.volume, speed * depth * breadth * flow.state.time, dx * depth * breadth);
    } else {
      EXPECT_GT(inlet.short_steps, 0);
    }
  }
}

/// Particles enter with the velocity of the profile, whose mean is the prescribed velocity.
TEST(OpenEnd, AProfileHasTheMeanThatIsAskedFor) {
  CaseSpec spec = channel<2>(1.0, 0.4);
  spec.fluid.clear();
  spec.study.length = 0.4;
  spec.physics.gravity = {0.0, 0.0};
  spec.walls[0].max[1] = spec.inlets[0].to[1] = spec.outlets[0].to[1] = 0.4;
  spec.inlets[0].velocity = 1.5;
  spec.inlets[0].profile = "3*s";
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  pass_and_step(flow);
  const Particles<2>& particles = flow.state.particles;
  double sum = 0.0;
  ASSERT_EQ(count_fluid(flow), 8u);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    sum += particles.velocity[i][0];
    EXPECT_NEAR(particles.velocity[i][0], 1.5 * 2.0 * particles.position[i][1] / 0.4, 1e-6);
  }
  EXPECT_NEAR(sum / 8.0, 1.5, 1e-6);
}

/// A dry channel floods from a reservoir, with water no deeper than the level and initially not slower than critical.
TEST(OpenEnd, AReservoirFloodsADryChannel) {
  CaseSpec spec = channel<2>(1.5, 0.4);
  spec.fluid.clear();
  spec.inlets[0].level = 0.4;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 0.5) pass_and_step(flow);
  const WaterAmount arrived = arrived_at(flow, 0);
  const double critical = std::sqrt(g * 0.4);
  EXPECT_GT(arrived.volume, 0.5 * 0.4 * (8.0 / 27.0) * critical) << "what a dam break of that depth lets pass";
  EXPECT_LT(arrived.volume, 0.5 * 0.4 * 2.0 * critical + dx * 0.4) << "no water is faster than its front";
}

}  // namespace open_end_test
}  // namespace tailwater
