// Moving walls: they displace water, drag none along, exert inertial pressure, and let no particle through.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "case/driven_walls.h"
#include "parts/damping_zones.h"
#include "parts/wave_makers.h"
#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

struct Way {
  const char* name;
  Integrator integrator;
};

std::ostream& operator<<(std::ostream& out, const Way& way) { return out << way.name; }

CaseSpec case_with(const Way& way, double dx) {
  CaseSpec spec;
  spec.particles.spacing = dx;
  spec.scheme.integrator = way.integrator;
  return spec;
}

FluidTable water_box(Coordinates min, Coordinates max) {
  FluidTable water;
  water.min = std::move(min);
  water.max = std::move(max);
  return water;
}

WallTable chain(std::vector<Coordinates> points) {
  WallTable wall;
  wall.points = std::move(points);
  return wall;
}

/// A plate in the water.
WallTable gate(Coordinates min, Coordinates max, VectorField displacement) {
  WallTable wall;
  wall.name = "gate";
  wall.shape = WallShape::box;
  wall.min = std::move(min);
  wall.max = std::move(max);
  wall.fluid_side = FluidSide::outside;
  wall.displacement = std::move(displacement);
  return wall;
}

template <int Dim>
double kinetic_energy(const Flow<Dim>& flow) {
  return measure(flow).kinetic_energy;
}

/// Asserts that no particle is behind a wall.
template <int Dim>
void expect_all_in_front(const Flow<Dim>& flow) {
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    const Vec<Dim>& x = flow.state.particles.position[i];
    ASSERT_GT(flow.walls.boundary.nearest(x, 10.0).signed_distance, 0.0)
        << "at " << x.transpose() << ", t = " << flow.state.time;
  }
}

class MovingWall : public testing::TestWithParam<Way> {};

TEST_P(MovingWall, WhatAPistonSweepsTheWaterRises) {
  const double dx = 0.05;
  const double depth = 0.3;
  const double way = 0.2;
  const double duration = 4.0;
  CaseSpec spec = case_with(GetParam(), dx);
  WallTable piston = chain({{0.0, 1.0}, {0.0, 0.0}});
  piston.displacement = {"0.1*(1 - cos(pi*clamp(t/4, 0, 1)))", 0.0};
  spec.walls = {chain({{-0.3, 0.0}, {1.0, 0.0}, {1.0, 1.0}}), piston};
  spec.fluid = {water_box({0.0, 0.0}, {1.0, depth})};
  Flow<2> flow = make_flow<2>(spec);
  std::size_t stopped_at_walls = 0;
  while (flow.state.time < duration) stopped_at_walls += step(flow).interventions.stopped_at_walls;
  EXPECT_EQ(stopped_at_walls, 0u);
  expect_all_in_front(flow);
  double highest = 0.0;
  double nearest = 1.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    highest = std::max(highest, flow.state.particles.position[i][1]);
    nearest = std::min(nearest, flow.state.particles.position[i][0]);
  }
  // The water beside the piston has moved as far as the piston: first row and sloshing within dx.
  EXPECT_NEAR(nearest, way + 0.5 * dx, 0.5 * dx);
  // 1 m of water on 0.8 m. The piston is fastest at pi/4 way/duration * 2, which is slow compared with sqrt(g h). Its
  // waves have the height of its speed times sqrt(h/g), 0.014 m, and the level is known to half a row on either side.
  const double wave = 0.1 * std::numbers::pi / duration * std::sqrt(depth / g);
  EXPECT_NEAR(highest + 0.5 * dx, depth / (1.0 - way), 0.5 * dx + wave);
  const FlowMeasures measures = measure(flow);
  EXPECT_LT(std::abs(measures.density_error_mean), 0.01);
}

TEST_P(MovingWall, TankAcceleratedAsAWholeIsAtRestInItsFrame) {
  const double dx = 0.05;
  const double a = 0.25 * g;
  CaseSpec spec = case_with(GetParam(), dx);
  WallTable tank = chain({{0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}});
  tank.displacement = {"0.125*g*t^2", 0.0};
  spec.walls = {tank};
  FluidTable water;  // the level in the accelerated frame, normal to (-a, -g)
  water.shape = BlockShape::polygon;
  water.points = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.3}, {0.0, 0.55}};
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  sort_particles(flow);
  start(flow);
  const double felt = std::hypot(g, a);
  const double settling = std::sqrt(felt * dx / std::numbers::pi);  // as in a tank at rest
  const auto expect_hydrostatic = [&](double displacement) {
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i)) continue;
      const Vec<2> x = flow.state.particles.position[i] - Vec<2>(displacement, 0.0);
      const double exact = flow.setup.liquid.density * (g * (0.55 - x[1]) - a * x[0]);
      // The error of an inclined surface of a lattice of squares is larger than that of a level one by half a diagonal.
      EXPECT_LT(std::abs(flow.state.particles.pressure[i] - exact), 1.7 * flow.setup.liquid.density * felt * dx)
          << "at " << x.transpose();
    }
  };
  expect_hydrostatic(0.0);
  for (int n = 0; n < 50; ++n) {
    EXPECT_EQ(step(flow).interventions.stopped_at_walls, 0u);
    // Velocities are those at the end of the step, or in its middle.
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i)) continue;
      const Vec<2> relative = flow.state.particles.velocity[i] - Vec<2>(a * flow.state.time, 0.0);
      ASSERT_LT(relative.norm(), settling) << "step " << n;
    }
  }
  expect_hydrostatic(0.5 * a * flow.state.time * flow.state.time);
}

TEST_P(MovingWall, ABedThatSlidesUnderStillWaterDragsNothing) {
  const double dx = 0.05;
  const double depth = 0.3;
  CaseSpec spec = case_with(GetParam(), dx);
  spec.domain.periodic_x = {0.0, 1.0};
  WallTable bed = chain({{0.0, 0.0}, {1.0, 0.0}});
  bed.displacement = {"2*t", 0.0};
  spec.walls = {bed};
  spec.fluid = {water_box({0.0, 0.0}, {1.0, depth})};
  Flow<2> flow = make_flow<2>(spec);
  const double settling = std::sqrt(g * dx / std::numbers::pi);
  while (flow.state.time < 0.8) {  // more than a period of the domain
    EXPECT_EQ(step(flow).interventions.stopped_at_walls, 0u);
    ASSERT_LT(measure(flow).largest_speed, settling);
  }
  double momentum = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i))
      momentum += flow.state.particles.velocity[i][0] * flow.state.particles.volume[i];
  }
  EXPECT_LT(std::abs(momentum / depth), 0.01 * 2.0);  // mean velocity compared with that of the bed
}

TEST_P(MovingWall, ARoughOneTakesTheWaterAlong) {
  // Couette flow without a surface, from rest: after (H^2/nu) it is linear to exp(-pi^2).
  const double dx = 0.05;
  const double height = 0.5;
  CaseSpec spec = case_with(GetParam(), dx);
  spec.physics.gravity = {0.0, 0.0};
  spec.physics.viscosity = 0.25;
  spec.study.noise_viscosity = 0.0;
  spec.particles.jitter = 0.1;
  spec.domain.periodic_x = {0.0, 0.6};
  WallTable bed = chain({{0.0, 0.0}, {0.6, 0.0}});
  WallTable lid = chain({{0.6, height}, {0.0, height}});
  bed.slip = lid.slip = Slip::no_slip;
  lid.displacement = {"t", 0.0};
  spec.walls = {bed, lid};
  spec.fluid = {water_box({0.0, 0.0}, {0.6, height})};
  Flow<2> flow = make_flow<2>(spec);
  while (flow.state.time < height * height / spec.physics.viscosity) step(flow);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    // The position of a wall is known to a small part of dx; the profile has the slope 1/H.
    EXPECT_NEAR(flow.state.particles.velocity[i][0], flow.state.particles.position[i][1] / height, 0.2 * dx / height);
  }
}

TEST_P(MovingWall, AGateLiftedBetweenEqualLevelsLeavesThemSo) {
  const double dx = 0.05;
  const double depth = 0.4;
  const double thickness = 3.0 * dx;
  CaseSpec spec = case_with(GetParam(), dx);
  spec.walls = {chain({{0.0, 1.0}, {0.0, 0.0}, {1.15, 0.0}, {1.15, 1.0}}),
                gate({0.5, 0.0}, {0.65, 0.8}, {0.0, "2*max(0, t - 0.05)"})};
  spec.fluid = {water_box({0.0, 0.0}, {0.5, depth}), water_box({0.65, 0.0}, {1.15, depth})};
  Flow<2> flow = make_flow<2>(spec);
  // The water can gain the energy of its fall into the volume of the gate.
  const double won = flow.setup.liquid.density * g * depth * thickness * 0.5 * depth;
  std::size_t stopped_at_walls = 0;
  while (flow.state.time < 1.5) {
    stopped_at_walls += step(flow).interventions.stopped_at_walls;
    ASSERT_LT(kinetic_energy(flow), won);
    expect_all_in_front(flow);
  }
  EXPECT_EQ(stopped_at_walls, 0u);
  EXPECT_LT(kinetic_energy(flow), 0.25 * won);
}

template <int Dim>
void expect_clean_lock_gate(const Way& way) {
  const double dx = 0.05;
  CaseSpec spec = case_with(way, dx);
  spec.general.dimension = Dim;
  const double width = 0.3;  // 3D
  if constexpr (Dim == 2) {
    spec.walls = {chain({{0.0, 1.0}, {0.0, 0.0}, {1.65, 0.0}, {1.65, 1.0}}),
                  gate({0.5, 0.0}, {0.65, 0.8}, {0.0, "3*t"})};
    spec.fluid = {water_box({0.0, 0.0}, {0.5, 0.5}), water_box({0.65, 0.0}, {1.65, 0.1})};
  } else {
    spec.physics.gravity = {0.0, 0.0, -g};
    WallTable tank = gate({0.0, 0.0, 0.0}, {1.65, width, 1.0}, {});
    tank.fluid_side = FluidSide::inside;
    tank.open = {"+z"};
    spec.walls = {tank, gate({0.5, 0.0, 0.0}, {0.65, width, 0.8}, {0.0, 0.0, "3*t"})};
    spec.fluid = {water_box({0.0, 0.0, 0.0}, {0.5, width, 0.5}), water_box({0.65, 0.0, 0.0}, {1.65, width, 0.1})};
  }
  Flow<Dim> flow = make_flow<Dim>(spec);
  std::size_t stopped_at_walls = 0;
  std::size_t steps = 0;
  const double end = Dim == 2 ? 0.8 : 0.3;
  for (; flow.state.time < end; ++steps) {
    stopped_at_walls += step(flow).interventions.stopped_at_walls;
    expect_all_in_front(flow);
  }
  EXPECT_EQ(stopped_at_walls, 0u);
  double front = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i) && flow.state.particles.position[i][Dim - 1] > 0.2) {
      front = std::max(front, flow.state.particles.position[i][0]);
    }
  }
  EXPECT_GT(front, 0.65);  // the bore has formed
}

TEST_P(MovingWall, AGateLiftedFromALockLetsTheWaterGoAndNobodyThroughItself) { expect_clean_lock_gate<2>(GetParam()); }

TEST(MovingWall3D, AGateLiftedFromALockLetsTheWaterGoAndNobodyThroughItself) {
  expect_clean_lock_gate<3>({"explicit", Integrator::explicit_projection});
}

TEST(MovingWallStep, NoWallMovesMoreThanTheCourantNumberInAStep) {
  CaseSpec spec = case_with({"explicit", Integrator::explicit_projection}, 0.05);
  spec.walls = {chain({{0.0, 1.0}, {0.0, 0.0}, {1.15, 0.0}, {1.15, 1.0}}),
                gate({0.5, 0.0}, {0.65, 0.8}, {0.0, "50*max(0, t - 0.001)"})};
  spec.fluid = {water_box({0.0, 0.0}, {0.5, 0.1})};
  Flow<2> flow = make_flow<2>(spec);
  for (int n = 0; n < 20; ++n) {
    const double before = flow.state.time;
    step(flow);
    EXPECT_LE(50.0 * (std::max(0.0, flow.state.time - 0.001) - std::max(0.0, before - 0.001)),
              spec.scheme.courant * 0.05);
  }
}

/// A ship's tank: steps of 0.55 dx/sqrt(2 g L) = 72 ms.
Flow<3> ships_tank(const VectorField& displacement) {
  CaseSpec spec;
  spec.general.dimension = 3;
  spec.particles.spacing = 2.0;
  spec.physics.gravity = {0.0, 0.0, -g};
  spec.fluid = {water_box({-10.0, -20.0, 0.0}, {10.0, 20.0, 12.0})};
  spec.fluid[0].velocity.assign(3, 0.0);
  WallTable tank;
  tank.shape = WallShape::box;
  tank.min = {-10.0, -20.0, 0.0};
  tank.max = {10.0, 20.0, 30.0};
  tank.fluid_side = FluidSide::inside;
  tank.displacement = displacement;
  spec.walls = {tank};
  spec.time.end = 12.0;
  return make_flow<3>(spec);
}

TEST(MovingWallStep, ASlowWallLeavesTheStepAsLongAsTheWaterAllows) {
  const Flow<3> flow = ships_tank({"0.01*t", 0.0, 0.0});
  EXPECT_NEAR(next_time_step(flow), 0.55 * 2.0 / std::sqrt(2.0 * g * 12.0), 1e-12);
}

TEST(MovingWallStep, AWallThatGoesOutAndBackWithinAStepIsSeen) {
  const double step_of_water = 0.55 * 2.0 / std::sqrt(2.0 * g * 12.0);
  // After a whole step of the water the wall would be back.
  const Flow<3> flow = ships_tank({fmt::format("3*sin(pi*t/{:.17g})", step_of_water), 0.0, 0.0});
  const double dt = next_time_step(flow);
  EXPECT_LE(3.0 * std::sin(std::numbers::pi * dt / step_of_water), 0.55 * 2.0 + 1e-9);
  EXPECT_LT(dt, 0.5 * step_of_water);
}

INSTANTIATE_TEST_SUITE_P(Integrators, MovingWall,
                         testing::Values(Way{"explicit", Integrator::explicit_projection},
                                         Way{"implicit", Integrator::implicit_projection}),
                         [](const auto& test) { return std::string(test.param.name); });

/// Still water 0.44 m deep in front of a plate that absorbs waves over a still depth of 0.4 m.
CaseSpec absorber_case(double at) {
  CaseSpec spec;
  spec.particles.spacing = 0.02;
  spec.fluid = {water_box({at, 0.0}, {at + 2.0, 0.44})};
  spec.walls = {chain({{-1.0, 1.0}, {-1.0, 0.0}, {at + 2.0, 0.0}, {at + 2.0, 1.0}})};
  WaveMakerTable maker;
  maker.name = "absorber";
  maker.from = {at, 0.0};
  maker.to = {at, 0.8};
  maker.depth = 0.4;
  maker.waves = WaveKind::none;
  maker.absorption = Absorption::active;
  spec.wave_makers = {maker};
  append_driven_walls(spec);
  return spec;
}

TEST(WaveMaker, GivesWayByTheElevationInFrontOfIt) {
  // The linear weights count the lattice exactly, for any position of the plate. For long waves the gain is sqrt(g/h).
  for (const double at : {0.0, 0.013}) {
    Flow<2> flow = make_flow<2>(absorber_case(at));
    flow.part<WaveMakers<2>>().begin_step(flow, 2e-3);
    EXPECT_NEAR(flow.state.motion.wave_makers[0].rate, -0.04 * std::sqrt(g / 0.4), 1e-12);
    EXPECT_EQ(flow.state.motion.wave_makers[0].correction, 0.0);
  }
}

TEST(WaveMaker, MovesAsItWasSteered) {
  Flow<2> flow = make_flow<2>(absorber_case(0.0));
  double expected = 0.0;
  for (int step = 0; step < 3; ++step) {
    advance(flow, 2e-3);
    expected += 2e-3 * flow.state.motion.wave_makers[0].rate;
    for (const WallFace<2>& face : flow.walls.boundary.faces) {
      if (face.wall == 1) {
        EXPECT_NEAR(face.corners[0][0], expected, 1e-12);
      }
    }
  }
  EXPECT_LT(expected, -1e-3);
  expect_all_in_front(flow);
}

// Water that moves as the zone's waves at the time at which a step starts feels no force; water at rest is driven.
TEST(DampingZones, LeaveAFlowThatIsTheirTarget) {
  CaseSpec spec = case_with({"", Integrator::explicit_projection}, 0.05);
  spec.fluid = {water_box({0.0, 0.0}, {2.0, 0.4})};
  spec.walls = {chain({{0.0, 0.8}, {0.0, 0.0}, {2.0, 0.0}, {2.0, 0.8}})};
  DampingTable zone;
  zone.min = {0.0, 0.0};
  zone.max = {2.0, 0.8};
  zone.strength = 5.0;
  zone.waves = WaveKind::regular;
  zone.height = 0.05;
  zone.period = 1.2;
  zone.depth = zone.level = 0.4;
  spec.damping = {zone};
  Flow<2> flow = make_flow<2>(spec);
  flow.state.time = 3.1;
  const WaveZone<2> waves(spec, zone);
  StepStart<2> start;
  start.position = flow.state.particles.position;
  start.velocity.assign(flow.state.particles.owned, Vec<2>::Zero());
  const auto& part = flow.part<DampingZones<2>>();
  std::vector<double> rate;
  part.add_damping_rate(flow, start, rate);
  std::vector<Vec<2>> drive;
  part.add_relaxation(flow, start, drive);
  double largest = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    const Vec<2> target = waves.target(start.position[i], 3.1);
    EXPECT_LT((drive[i] - rate[i] * target).norm(), 1e-12);
    largest = std::max(largest, drive[i].norm());
  }
  EXPECT_GT(largest, 0.1);
}

// Water without a surface moves as a whole, and approaches the current at the mean rate over all water, about a sixth
// of the strength: after 4 s it lacks exp(-7) of the current.
TEST(DampingZones, BringTheWaterToTheirCurrent) {
  for (const AxisDirection towards : {AxisDirection::plus_x, AxisDirection::minus_x}) {
    CaseSpec spec = periodic_square(0.1);
    DampingTable zone;
    zone.min = {0.0, 0.0};
    zone.max = {0.5, 1.0};
    zone.towards = towards;
    zone.strength = 12.0;
    zone.transport = 0.3;
    spec.damping = {zone};
    Flow<2> flow = make_flow<2>(spec);
    const double current = towards == AxisDirection::plus_x ? 0.3 : -0.3;
    const auto mean_velocity = [&] {
      Vec<2> sum = Vec<2>::Zero();
      for (std::size_t i = 0; i < flow.state.particles.owned; ++i) sum += flow.state.particles.velocity[i];
      return Vec<2>(sum / static_cast<double>(flow.state.particles.owned));
    };
    for (int n = 0; n < 400; ++n) advance(flow, 0.01);
    EXPECT_NEAR(mean_velocity()[0] / current, 1.0, 2e-3);
    EXPECT_NEAR(mean_velocity()[1], 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace tailwater
