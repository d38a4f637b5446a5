// Spaces that walls seal keep their gas, and its pressure follows their volume at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "air/enclosed_air.h"
#include "flow/measure.h"
#include "flow/stages.h"
#include "schemes/cases.h"
#include "schemes/force_reader.h"
#include "schemes/open_ends.h"
#include "support/dimensions.h"

namespace tailwater {
namespace sealed_air_test {
namespace {

constexpr double atmosphere = 101325.0;

template <class D>
class SealedAir : public testing::Test {};
TYPED_TEST_SUITE(SealedAir, Dimensions);

template <int Dim>
double gas_of(const Flow<Dim>& flow) {
  double gas = 0.0;
  for (const AirPocket& pocket : air_of(flow).state.pockets) gas += pocket.gas;
  for (const AirPocket& pocket : air_of(flow).state.hidden) gas += pocket.gas;
  return gas;
}

/// A closed tank, 0.5 m wide and high, with water 0.1 m deep.
template <int Dim>
CaseSpec closed_tank(double dx, AirPockets gas) {
  CaseSpec spec = tank_case<Dim>(dx, 0.5, 0.1);
  spec.walls[0].max[Dim - 1] = 0.5;
  spec.walls[0].open.clear();
  spec.air.pockets = gas;
  return spec;
}

// Water comes in through a side wall, below the surface: Boyle.
TYPED_TEST(SealedAir, HasTheVolumeThatInflowLeaves) {
  constexpr int Dim = TypeParam::value;
  constexpr double discharge = 0.02;  // m^2/s
  constexpr double width = Dim == 2 ? 1.0 : 0.5;
  CaseSpec spec = closed_tank<Dim>(Dim == 2 ? 0.025 : 0.05, AirPockets::isothermal);
  spec.fluid[0].max[Dim - 1] = 0.2;
  spec.walls[0].open = {"-x"};
  WallTable above;  // of the inlet
  above.shape = WallShape::box;
  above.fluid_side = FluidSide::outside;
  above.min = Coordinates(Dim, -0.3);
  above.max = Coordinates(Dim, 0.8);
  above.max[0] = 0.0;
  above.min[Dim - 1] = 0.1;
  spec.walls.push_back(above);
  InletTable inlet;
  inlet.from = Coordinates(Dim, 0.0);
  inlet.to = Coordinates(Dim, 0.5);
  inlet.to[0] = 0.0;
  inlet.to[Dim - 1] = 0.1;
  inlet.direction = Coordinates(Dim, 0.0);
  inlet.direction[0] = 1.0;
  inlet.discharge = discharge * width;
  spec.inlets = {inlet};
  Flow<Dim> flow = make_flow<Dim>(spec);
  start(flow);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 1U);
  const double gas = gas_of(flow);
  while (flow.state.time < 1.0) {
    pass_and_step(flow);
    const double left = gas - discharge * width * flow.state.time;
    EXPECT_NEAR(air_of(flow).measures().pressure, atmosphere * (gas / left - 1.0), 0.003 * atmosphere);
  }
  EXPECT_NEAR(gas_of(flow), gas, 1e-12 * gas);
}

/// The closed tank in 2D with air at this pressure [Pa] above the atmosphere's.
CaseSpec tank_under_pressure(double pressure) {
  CaseSpec spec = closed_tank<2>(0.025, AirPockets::isothermal);
  PocketTable pocket;
  pocket.at = {0.1, 0.4};
  pocket.overpressure = pressure;
  spec.pockets = {pocket};
  return spec;
}

// The air presses on all walls, and the water adds its weight: the whole force is that weight.
TEST(SealedAir, PressesOnWallsAlongTheirNormalsOnly) {
  CaseSpec spec = tank_under_pressure(50000.0);
  spec.probes = {force_probe({0.0, 0.0})};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  double dt = 0.0;
  for (int n = 0; n < 3; ++n) dt = step(flow).dt;
  const double weight = 1000.0 * g * 0.5 * 0.1;
  EXPECT_NEAR(Reader<2>(spec, flow).force(dt)[1], -weight, 0.1 * weight);  // 1.3 with the force along the walls
}

// A wall of a closed tank whose bed goes on behind it: the space behind the wall is no air beside the water.
TEST(SealedAir, PressesOnAWallWhoseBedGoesOn) {
  constexpr double dx = 0.05, width = 0.6, height = 0.6, depth = 0.2, pressure = 60000.0;
  CaseSpec spec = closed_tank<2>(dx, AirPockets::isothermal);
  spec.fluid[0].min = {0.0, 0.0};
  spec.fluid[0].max = {width, depth};
  WallTable tank;
  tank.name = "tank";
  tank.points = {{width + 0.3, height}, {0.0, height}, {0.0, 0.0}, {width + 0.3, 0.0}};
  WallTable end;
  end.name = "end";
  end.points = {{width, 0.0}, {width, height}};
  spec.walls = {tank, end};
  PocketTable pocket;
  pocket.at = {0.3, 0.4};
  pocket.overpressure = pressure;
  spec.pockets = {pocket};
  spec.probes = {force_probe({0.0, 0.0}, {"end"}), force_probe({0.0, 0.0}, {"tank"})};
  spec.probes[1].name = "tank";
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  double force = 0.0;
  double weight = 0.0;
  for (int n = 0; n < 10; ++n) {
    const double dt = step(flow).dt;
    force += 0.1 * Reader<2>(spec, flow).force(dt)[0];
    weight -= 0.1 * Reader<2>(spec, flow, 1).force(dt)[1];
  }
  const double expected = pressure * height + 0.5 * 1000.0 * g * depth * depth;
  EXPECT_NEAR(force, expected, 0.003 * expected);  // 0.994 with the space behind the wall as air
  const double of_water = 1000.0 * g * width * depth;
  EXPECT_NEAR(weight, of_water, 0.5 * pressure * dx);  // 0.8 P dx with air in the corner behind the wall
}

// A tank with a plate between two pockets moves as a whole, and its water with it: no gas passes the plate.
TEST(SealedAir, StaysInItsPocketInATankThatMoves) {
  CaseSpec spec = tank_under_pressure(0.0);
  spec.fluid[0].max[1] = 0.3;
  spec.fluid[0].velocity = {1.0, 0.0};
  spec.time.end = 0.3;
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.points = {{0.25, 0.5}, {0.25, 0.1}};
  spec.walls.push_back(plate);
  for (WallTable& wall : spec.walls) wall.displacement = {"t", 0.0};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 2U);
  const double gas = air_of(flow).state.pockets[0].gas;
  while (flow.state.time < 0.3) step(flow);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 2U);
  EXPECT_NEAR(air_of(flow).state.pockets[0].gas, gas, 0.01 * gas);
}

/// A lid between side walls that go on above it.
template <int Dim>
CaseSpec tank_below_lid(bool is_box) {
  CaseSpec spec = closed_tank<Dim>(0.05, AirPockets::isothermal);
  spec.walls[0].max[Dim - 1] = 0.8;
  spec.walls[0].open = {Dim == 2 ? "+y" : "+z"};
  WallTable lid;
  if (is_box) {
    lid.shape = WallShape::box;
    lid.fluid_side = FluidSide::outside;
    lid.min = Coordinates(Dim, 0.0);
    lid.min[Dim - 1] = 0.5;
    lid.max = Coordinates(Dim, 0.5);
    lid.max[Dim - 1] = 0.6;
  } else {
    lid.points = {{0.5, 0.5}, {0.0, 0.5}};
    lid.fluid_side = FluidSide::left;
  }
  spec.walls.push_back(lid);
  return spec;
}

TYPED_TEST(SealedAir, IsClosedByALidBetweenWallsThatGoOn) {
  constexpr int Dim = TypeParam::value;
  for (const bool is_box : {true, false}) {
    if (Dim == 3 && !is_box) continue;
    Flow<Dim> flow = make_flow<Dim>(tank_below_lid<Dim>(is_box));
    start(flow);
    ASSERT_EQ(air_of(flow).state.pockets.size(), 1U) << is_box;
    EXPECT_NEAR(air_of(flow).measures().volume, 0.4 * std::pow(0.5, Dim - 1), 1e-6) << is_box;
  }
}

// The lid sinks by a tenth of the air's height.
TYPED_TEST(SealedAir, IsPressedTogetherByALidThatSinks) {
  constexpr int Dim = TypeParam::value;
  for (const bool is_box : {true, false}) {
    if (Dim == 3 && !is_box) continue;
    CaseSpec spec = tank_below_lid<Dim>(is_box);
    spec.walls[1].displacement = VectorField(Dim, 0.0);
    spec.walls[1].displacement[Dim - 1] = "-0.1*t";
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    while (flow.state.time < 0.4) step(flow);
    const double expected = atmosphere * (0.4 / (0.4 - 0.1 * flow.state.time) - 1.0);
    EXPECT_NEAR(air_of(flow).measures().pressure, expected, 0.01 * expected) << is_box;
  }
}

// Tank and lid pass between the cells in which air is searched for, also where the lid is listed first.
TYPED_TEST(SealedAir, IsClosedByALidThatMovesWithTheTank) {
  constexpr int Dim = TypeParam::value;
  for (const bool is_first : {false, true}) {
    if (Dim == 3 && is_first) continue;
    CaseSpec spec = tank_below_lid<Dim>(true);
    for (WallTable& wall : spec.walls) {
      wall.displacement = VectorField(Dim, 0.0);
      wall.displacement[0] = "0.2*t";
    }
    if (is_first) std::swap(spec.walls[0], spec.walls[1]);
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    const double gas = gas_of(flow);
    while (flow.state.time < 0.25) {  // two cells
      step(flow);
      ASSERT_EQ(air_of(flow).state.pockets.size(), 1U) << flow.state.time;
    }
    EXPECT_NEAR(gas_of(flow), gas, 1e-12 * gas);
    EXPECT_EQ(air_of(flow).state.hidden.size(), 0U);
    EXPECT_NEAR(air_of(flow).measures().volume, 0.4 * std::pow(0.5, Dim - 1), 1e-3 * std::pow(0.5, Dim - 1));
  }
}

// Cells have their centres between the planes of lid and tank, at the corners of the lid, and between its rows, whose
// steps fit the lid. Through such cells all of the gas leaked.
TEST(SealedAir3D, IsClosedByALidOfAnyWidth) {
  for (const double width : {0.507, 0.515, 0.52}) {
    CaseSpec spec = tank_below_lid<3>(true);
    for (Coordinates* corner : {&spec.walls[0].max, &spec.walls[1].max, &spec.fluid[0].max}) {
      for (int axis = 0; axis < 2; ++axis) (*corner)[static_cast<std::size_t>(axis)] = width;
    }
    for (WallTable& wall : spec.walls) {
      wall.displacement = VectorField(3, 0.0);
      wall.displacement[0] = "0.2*t";
    }
    Flow<3> flow = make_flow<3>(spec);
    start(flow);
    const double gas = gas_of(flow);
    EXPECT_NEAR(gas, 0.4 * width * width, 1e-3 * gas) << width;
    while (flow.state.time < 0.15) step(flow);
    EXPECT_NEAR(gas_of(flow), gas, 1e-12 * gas) << width;
  }
}

// Pressure that all of the air has in common has no force.
TYPED_TEST(SealedAir, OfLowPressureLeavesWaterAtRest) {
  constexpr int Dim = TypeParam::value;
  double speed[2] = {};
  for (const double pressure : {0.0, -50000.0}) {
    CaseSpec spec = closed_tank<Dim>(0.05, AirPockets::adiabatic);
    spec.fluid[0].max[Dim - 1] = 0.3;
    spec.pockets.resize(1);
    spec.pockets[0].at = Coordinates(Dim, 0.4);
    spec.pockets[0].overpressure = pressure;
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    while (flow.state.time < 0.3) {
      step(flow);
      speed[pressure < 0.0] = std::max(speed[pressure < 0.0], largest_speed(flow));
    }
    EXPECT_NEAR(air_of(flow).measures().pressure, pressure, 1.0);
  }
  EXPECT_NEAR(speed[1], speed[0], 1e-3);
}

/// A tank that rolls until its air is parted many times.
CaseSpec rolling_tank() {
  CaseSpec spec = tank_case<2>(0.02, 0.8, 0.1);
  spec.walls[0].max[1] = 0.4;
  spec.walls[0].open.clear();
  spec.walls[0].rotation = "0.12*sin(3.6*t)*min(1, t)";
  spec.walls[0].pivot = {0.4, 0.0};
  return spec;
}

/// J; the largest rise of the energy of water and gas that walls have not brought, until t = 6 s. Visits each step.
template <class Visit>
double largest_rise(Flow<2>& flow, Visit&& visit) {
  double least = measure(flow).energy();
  double rise = 0.0;
  double brought = 0.0;
  while (flow.state.time < 6.0) {
    if (flow.state.step % 10 == 0) sort_particles(flow);
    const StepReport report = advance(flow, next_time_step(flow));
    brought += report.work.walls + report.work.air;
    const double energy = measure(flow).energy() - brought;
    rise = std::max(rise, energy - least);
    least = std::min(least, energy);
    visit();
  }
  return rise;
}

// Gas and volume are conserved to rounding. The density source and the shifts of particles lift the water and let it
// sink, so the energy rises before there is a pocket; with air it rises by no more.
TEST(SealedTank, KeepsItsGasWhileItRolls) {
  Flow<2> without = make_flow<2>(rolling_tank());
  start(without);
  const double scale = measure(without).energy();
  const double rise_without = largest_rise(without, [] {});
  CaseSpec spec = rolling_tank();
  spec.air.pockets = AirPockets::adiabatic;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const double gas = gas_of(flow);
  const double volume = air_of(flow).measures().volume;
  const AirState& air = air_of(flow).state;
  const double rise = largest_rise(flow, [&] {
    double sum = air_of(flow).measures().volume;
    for (const AirPocket& pocket : air.hidden) sum += pocket.volume;
    EXPECT_NEAR(sum, volume, 1e-9 * volume);
    EXPECT_NEAR(gas_of(flow), gas, 1e-12 * gas);
  });
  EXPECT_GE(air.begun, 2) << "else nothing was parted";  // rounding decides whether there are three or more
  EXPECT_EQ(air.gas_lost, 0.0);
  EXPECT_NEAR(air.gas_found, gas, 1e-12 * gas);
  EXPECT_LT(rise, rise_without + 1e-3 * scale);
}

/// Water 0.6 and 0.5 m high in the legs of a closed tube 1 m high, with air above.
CaseSpec closed_tube(AirPockets gas) {
  CaseSpec spec;
  spec.particles.spacing = 0.025;
  WallTable tube;
  tube.points = {{0.0, 1.0}, {0.0, 0.0}, {0.6, 0.0}, {0.6, 1.0}, {0.4, 1.0},
                 {0.4, 0.2}, {0.2, 0.2}, {0.2, 1.0}, {0.0, 1.0}};
  tube.fluid_side = FluidSide::left;
  spec.walls = {tube};
  const auto block = [](Coordinates min, Coordinates max) {
    FluidTable water;
    water.min = std::move(min);
    water.max = std::move(max);
    return water;
  };
  spec.fluid = {block({0.0, 0.0}, {0.2, 0.6}), block({0.2, 0.0}, {0.4, 0.2}), block({0.4, 0.0}, {0.6, 0.5})};
  spec.air.pockets = gas;
  return spec;
}

/// s; the period of the tube without gas: twice the time until the water turns.
double open_period() {
  Flow<2> flow = make_flow<2>(closed_tube(AirPockets::none));
  start(flow);
  double largest = 0.0;
  double kinetic[3] = {};  // after the last three steps
  double dt = 0.0;
  do {
    const double time = flow.state.time;
    step(flow);
    dt = flow.state.time - time;
    kinetic[0] = kinetic[1];
    kinetic[1] = kinetic[2];
    kinetic[2] = measure(flow).kinetic_energy;
    largest = std::max(largest, kinetic[2]);
  } while (kinetic[2] < kinetic[1] || kinetic[2] > 0.1 * largest);
  const double behind = 0.5 * (kinetic[0] - kinetic[2]) / (kinetic[0] - 2.0 * kinetic[1] + kinetic[2]) - 1.0;  // steps
  return 2.0 * (flow.state.time + behind * dt);
}

// Two gas springs and the weight move 1.2 m of water to and fro. Its effective length is that of the open tube.
TEST(ClosedTube, SwingsBetweenItsPocketsOfAir) {
  Flow<2> flow = make_flow<2>(closed_tube(AirPockets::isothermal));
  start(flow);
  ASSERT_EQ(air_of(flow).state.pockets.size(), 2U);
  const double gas = gas_of(flow);
  const double springs = atmosphere / 1000.0 * (1.0 / 0.4 + 1.0 / 0.5) / (2.0 * g);  // stiffness over the weight's
  // Pa; at rest the pressures differ by the weight of 0.1 m of water, less what gives way.
  const double settled = 1000.0 * g * 0.1 * springs / (1.0 + springs);
  double mean = 0.0;
  double before = -settled;
  std::vector<double> crossings;
  int steps = 0;
  while (flow.state.time < 1.0) {
    const double time = flow.state.time;
    step(flow);
    const std::vector<AirPocket>& pockets = air_of(flow).state.pockets;
    ASSERT_EQ(pockets.size(), 2U);
    const double difference = std::abs(air_of(flow).pressure_of(pockets[1]) - air_of(flow).pressure_of(pockets[0]));
    mean += difference;
    ++steps;
    const double now = difference - settled;
    if (before * now < 0.0) crossings.push_back(time + (flow.state.time - time) * before / (before - now));
    before = now;
  }
  EXPECT_NEAR(gas_of(flow), gas, 1e-12 * gas);
  EXPECT_NEAR(mean / steps, settled, 0.1 * settled);
  ASSERT_GE(crossings.size(), 4U);
  const double period = 2.0 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  const double expected = open_period() / std::sqrt(1.0 + springs);
  EXPECT_NEAR(period, expected, 0.02 * expected);
}

}  // namespace
}  // namespace sealed_air_test
}  // namespace tailwater
