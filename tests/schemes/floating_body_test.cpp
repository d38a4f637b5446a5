// Bodies that the water moves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies/floating_bodies.h"
#include "schemes/float_boxes.h"
#include "schemes/open_ends.h"
#include "support/circle.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class D>
class FloatingBodyTest : public testing::Test {};
TYPED_TEST_SUITE(FloatingBodyTest, Dimensions);

// Forces between particles are equal and opposite, and the residual of the iteration is carried over to the next step.
// The momentum of water and body together therefore changes by rounding only. Without gravity, a block of water hits a
// box off its centre.
TYPED_TEST(FloatingBodyTest, KeepsMomentumWithTheWater) {
  constexpr int Dim = TypeParam::value;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    constexpr double dx = 0.1;
    CaseSpec spec = free_case(dx);
    spec.general.dimension = Dim;
    spec.physics.gravity = Coordinates(Dim, 0.0);
    spec.scheme.integrator = integrator;
    FluidTable water;
    water.min = Coordinates(Dim, 0.0);
    water.max = Coordinates(Dim, 0.8);
    water.velocity = VectorField(Dim, 0.0);
    water.velocity[0] = 1.0;
    spec.fluid = {water};
    Coordinates low(Dim, 0.3);
    Coordinates high(Dim, 1.1);
    low[0] = 0.9;
    high[0] = 1.7;
    add_box(spec, low, high, 500.0);
    Flow<Dim> flow = make_flow<Dim>(spec);
    const auto momentum = [&] {
      Vec<Dim> sum = Vec<Dim>::Zero();
      const Particles<Dim>& particles = flow.state.particles;
      for (std::size_t i = 0; i < particles.owned; ++i) {
        if (particles.is_fluid(i)) sum += flow.setup.liquid.density * particles.volume[i] * particles.velocity[i];
      }
      const BodyState<Dim>& body = flow.state.motion.bodies.each[0];
      return Vec<Dim>(sum + bodies_of(flow).bodies[0].mass * body.linear_velocity() +
                      body.carried_over.template head<Dim>());
    };
    const Vec<Dim> before = momentum();
    for (int n = 0; n < (Dim == 2 ? 40 : 14); ++n) step(flow);
    EXPECT_LT((momentum() - before).norm(), 1e-11 * before.norm());
    const BodyState<Dim>& body = flow.state.motion.bodies.each[0];
    EXPECT_GT(body.velocity[0], 0.1);  // the box was hit
    EXPECT_GT(body.angular_velocity().norm(), 0.01);
  }
}

// A box at its draught, with half or a tenth of the density of water. The pressure is that of a tank at rest, with
// density errors within a row; the box moves by less than a tenth of dx.
TEST(FloatingBody, StaysAtItsDraught) {
  constexpr double dx = 0.025;
  for (const double lightness : {0.5, 0.1}) {
    for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
      CaseSpec spec = tank_case<2>(dx, 1.0, 0.4);
      spec.scheme.integrator = integrator;
      const double height = 0.1 / lightness;
      add_box(spec, {0.35, 0.3}, {0.65, 0.3 + height}, lightness * 1000.0);
      Flow<2> flow = make_flow<2>(spec);
      start(flow);
      const Vec<2> drawn = bodies_of(flow).bodies[0].drawn.centre;
      while (flow.state.time < 0.5) {
        step(flow);
        const BodyState<2>& body = flow.state.motion.bodies.each[0];
        ASSERT_LT((body.centre - drawn).norm(), 0.1 * dx) << "t = " << flow.state.time << ", " << lightness;
      }
    }
  }
}

/// The height of the body stays within `bound` [m] of where it was drawn, in every step until `end` [s].
template <int Dim>
void expect_at_draught(Flow<Dim>& flow, double end, double bound) {
  const double drawn = bodies_of(flow).bodies[0].drawn.centre[Dim - 1];
  while (flow.state.time < end) {
    step(flow);
    ASSERT_NEAR(flow.state.motion.bodies.each[0].centre[Dim - 1], drawn, bound) << "t = " << flow.state.time;
  }
}

// The dry floor of an open hull is 4 dx below the level. It had the balanced pressure as if it were wet, by which the
// hull sank by 0.4 dx.
TEST(FloatingBody, AnOpenHullStaysAtItsDraught) {
  constexpr double dx = 0.02, level = 0.4, bottom = 0.2, floor = 0.32;
  CaseSpec spec = tank_case<2>(dx, 1.2, level);
  spec.fluid[0] = FluidTable{};
  spec.fluid[0].shape = BlockShape::fill;
  spec.fluid[0].seed = {0.1, 0.1};
  spec.fluid[0].level = level;
  add_box(spec, {0.4, bottom}, {0.8, 0.6}, 1.0);
  spec.walls.back().shape = WallShape::polygon;
  spec.walls.back().points = {{0.4, bottom}, {0.8, bottom}, {0.8, 0.6},  {0.68, 0.6},
                              {0.68, floor}, {0.52, floor}, {0.52, 0.6}, {0.4, 0.6}};
  spec.bodies[0].mass = 1000.0 * 0.4 * (level - bottom);
  spec.bodies[0].free = {"y"};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  expect_at_draught(flow, 0.5, 0.1 * dx);
}

// A T of two boxes, as heavy as the water it displaces. The parts that the boxes hide of each other counted as wet, by
// which the T rose by 5 mm in the time of the test.
TEST(FloatingBody, OfSeveralWallsHoversUnderWater) {
  constexpr double dx = 0.025;
  for (const double overlap : {0.0, 0.001, 0.05}) {
    CaseSpec spec = tank_case<2>(dx, 2.0, 0.5);
    add_box(spec, {0.8, 0.25}, {1.2, 0.35}, 1000.0, "deck");
    spec.walls.push_back(spec.walls.back());
    spec.walls.back().name = "keel";
    spec.walls.back().min = {0.95, 0.1};
    spec.walls.back().max = {1.05, 0.25 + overlap};
    spec.bodies[0].walls.push_back("keel");
    spec.bodies[0].mass = 1000.0 * (0.4 * 0.1 + 0.1 * 0.15);
    spec.bodies[0].free = {"y"};
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    expect_at_draught(flow, 0.15, 0.01 * dx);
  }
}

// A box at its draught in a flume 6 dx wide, which it spans from side wall to side wall. Under its edges the pressure
// of the water also acts on wall particles of the side walls, with 7 % of the weight of the box.
TEST(FloatingBody, StaysAtItsDraughtBetweenSideWalls) {
  constexpr double dx = 0.025;
  CaseSpec spec = tank_case<3>(dx, 0.6, 0.3);
  spec.fluid[0].max[1] = spec.walls[0].max[1] = 6.0 * dx;
  add_box(spec, {0.15, 0.0, 0.2}, {0.45, 6.0 * dx, 0.4}, 500.0);
  spec.bodies[0].free = {"z"};
  Flow<3> flow = make_flow<3>(spec);
  start(flow);
  expect_at_draught(flow, 0.3, 0.1 * dx);
}

// A cylinder as heavy as the water it displaces, set in motion in deep water. The water takes half of its momentum at
// once, and the cylinder keeps the rest. In proportion to the depth, pairs pulled it back to where the water had been:
// on the first half of its diameter it lost two fifths of its speed.
TEST(FloatingBody, CoastsUnderWater) {
  constexpr double dx = 0.01, D = 0.1, speed = 0.2;
  CaseSpec spec = tank_case<2>(dx, 0.8, 0.6);
  WallTable hull;
  hull.name = "hull";
  hull.shape = WallShape::polygon;
  hull.points = circle(48, 0.5 * D, {0.4, 0.3});
  hull.fluid_side = FluidSide::outside;
  BodyTable body = body_of("hull", 1000.0 * 0.25 * std::numbers::pi * D * D, {0.4, 0.3}, {});
  body.velocity = {speed, 0.0};
  body.free = {"x"};
  add_body(spec, hull, body);
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const BodyState<2>& state = flow.state.motion.bodies.each[0];
  while (state.centre[0] < 0.4 + 0.5 * D) step(flow);
  EXPECT_GT(state.velocity[0], 0.8 * (0.5 * speed));
}

// A box as heavy as the water it displaces, in a full closed tank. From the first step on, the pressure of the current
// step acts on the box, raised until no water has tension. With the pressure of the previous step, no force would act
// on the top of the box, and the box would begin to sink with a tenth of gravity.
TEST(FloatingBody, HoversInATankThatIsFull) {
  constexpr double dx = 0.025;
  CaseSpec spec = tank_case<2>(dx, 0.6, 0.4);
  spec.walls[0].max[1] = 0.4;
  spec.walls[0].open = {};
  add_box(spec, {0.2, 0.1}, {0.4, 0.3}, 1000.0);
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  for (int n = 0; n < 20; ++n) {
    step(flow);
    const BodyState<2>& body = flow.state.motion.bodies.each[0];
    ASSERT_LT(body.acceleration.head<2>().norm(), 0.01 * g) << "step " << n;
    ASSERT_LT(body.linear_velocity().norm(), 1e-3) << "step " << n;
  }
}

// A box is released half a spacing above its draught in a narrow tank, with short steps. From the second step on,
// tension is limited, and beside water with limited tension the added inertia of the box is a quarter of its normal
// value. The box must not be thrown up by this: all water would then have tension, would be limited, and would fall
// with the box.
TEST(FloatingBody, IsNotThrownByWaterThatWasHeldBack) {
  constexpr double dx = 0.015;
  CaseSpec spec = tank_case<2>(dx, 0.42, 0.375);
  spec.scheme.courant = 0.2;
  add_box(spec, {0.06, 0.3075}, {0.36, 0.4575}, 500.0);
  spec.bodies[0].free = {"y"};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  for (int n = 0; n < 10; ++n) step(flow);
  EXPECT_LT(std::abs(flow.state.motion.bodies.each[0].linear_velocity()[1]), 0.2 * g * flow.state.time);
}

// A cylinder far below the surface, with a tenth of the density of water, is released: its buoyancy accelerates its
// mass and its added mass, which equals the displaced mass. The water is so deep, in particles, that its pressure needs
// a few steps to develop (softness, robust/rows.cpp). Images in walls and surface are (R/2h)^2 = 0.6 % each.
TEST(FloatingBody, IsAcceleratedWithItsAddedMass) {
  constexpr double dx = 0.02;
  constexpr double R = 0.12;
  CaseSpec spec = tank_case<2>(dx, 1.6, 1.6);
  WallTable hull;
  hull.name = "hull";
  hull.shape = WallShape::polygon;
  hull.fluid_side = FluidSide::outside;
  hull.points = circle(48, R, {0.8, 0.8});
  const double displaced = 1000.0 * std::numbers::pi * R * R;
  BodyTable body = body_of("hull", 0.1 * displaced, {0.8, 0.8}, {});
  body.free = {"x", "y"};
  add_body(spec, hull, body);
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  for (int n = 0; n < 10; ++n) step(flow);
  const double expected = 0.9 / 1.1 * g;
  EXPECT_NEAR(flow.state.motion.bodies.each[0].acceleration[1], expected, 0.04 * expected);
  EXPECT_NEAR(flow.state.motion.bodies.each[0].acceleration[0], 0.0, 0.01 * expected);
}

// A box four times as heavy as water sinks through the water to the bed, and no further.
TEST(FloatingBody, SinksToTheBedAndLiesThere) {
  constexpr double dx = 0.05;
  CaseSpec spec = tank_case<2>(dx, 1.2, 0.25);
  add_box(spec, {0.4, 0.15}, {0.8, 0.55}, 4000.0);
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const BodyState<2>& body = flow.state.motion.bodies.each[0];
  const auto lowest = [&] {
    return std::min(body.placement(Vec<2>(0.4, 0.15))[1], body.placement(Vec<2>(0.8, 0.15))[1]);
  };
  while (flow.state.time < 1.0) {
    step(flow);
    ASSERT_GT(lowest(), -1e-9) << "t = " << flow.state.time;
  }
  EXPECT_LT(lowest(), 1e-9);
  EXPECT_LT(std::abs(body.velocity[1]), 1e-6);
  EXPECT_LT(std::abs(angle_of<2>(body.placement.linear)[0]), 1e-6);
}

// A box half as heavy as water lies on the bed, without particles beneath it. The pressure of the water acts there
// nevertheless. The box stays as long as the water beside it is shallower than half its height, and rises where the
// water is deeper.
TYPED_TEST(FloatingBodyTest, LiesOnTheBedUntilTheWaterIsDeepEnough) {
  constexpr int Dim = TypeParam::value;
  constexpr double dx = 0.025;
  for (const double share : {0.8, 1.2}) {
    constexpr double gap = Dim == 2 ? 0.175 : 0.1;
    CaseSpec spec = tank_case<Dim>(dx, 0.25 + 2.0 * gap, share * 0.125);
    Coordinates low(Dim, gap);
    Coordinates high(Dim, gap + 0.25);
    low[Dim - 1] = 0.0;
    high[Dim - 1] = 0.25;
    add_box(spec, low, high, 500.0);
    spec.bodies[0].free = {Dim == 2 ? "y" : "z"};
    Flow<Dim> flow = make_flow<Dim>(spec);
    start(flow);
    const BodyState<Dim>& body = flow.state.motion.bodies.each[0];
    double highest = 0.0;
    while (flow.state.time < 0.25) {
      step(flow);
      highest = std::max(highest, body.centre[Dim - 1] - 0.125);
      ASSERT_GT(body.centre[Dim - 1] - 0.125, -1e-9);
    }
    if (share < 1.0) {
      EXPECT_LT(highest, 0.01 * dx);
    } else {
      EXPECT_GT(highest, 0.25 * dx);
    }
  }
}

/// Rise in 0.4 s of a body of this shape, half as heavy as water, from the bed under 0.6 m of water.
double rise_from_bed(std::vector<Coordinates> points, double area, double height, double dx, double x = 0.5) {
  CaseSpec spec = tank_case<2>(dx, 1.0, 0.6);
  WallTable hull;
  hull.name = "hull";
  hull.shape = WallShape::polygon;
  hull.fluid_side = FluidSide::outside;
  hull.points = std::move(points);
  const double mass = 500.0 * area;
  add_body(spec, hull, body_of("hull", mass, {x, 0.5 * height}, {mass * height * height / 8.0}));
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 0.4) step(flow);
  return flow.state.motion.bodies.each[0].centre[1] - 0.5 * height;
}

// Water presses under a round hull as well, where there is no space for particles. A cylinder that touches a bed goes
// with pi^2/3 - 1 times the water that it displaces, one far away with once: its rise is between those of both.
TEST(FloatingBody, RoundAndPointedBodiesComeOffTheBed) {
  constexpr double R = 0.125;
  const double displaced = std::numbers::pi * R * R;
  const double slowest = 0.5 * 0.4 * 0.4 * 0.5 * g / (0.5 + std::numbers::pi * std::numbers::pi / 3.0 - 1.0);
  const double fastest = 0.5 * 0.4 * 0.4 * 0.5 * g / 1.5;
  const double of_cylinder = rise_from_bed(circle(24, R, {0.5, R}), displaced, 2.0 * R, R / 6.0);
  EXPECT_GT(of_cylinder, slowest);
  EXPECT_LT(of_cylinder, fastest);
  EXPECT_GT(rise_from_bed({{0.45, 0.0}, {0.55, 0.0}, {0.65, 0.15}, {0.35, 0.15}}, 0.03, 0.15, 0.02), 0.5 * 0.15);
  EXPECT_GT(rise_from_bed({{0.5, 0.0}, {0.68, 0.18}, {0.5, 0.36}, {0.32, 0.18}}, 0.0648, 0.36, 0.02), 0.25 * 0.36);
}

// The water that a cylinder seals in the corner of bed and side wall follows it, as water would through the films. When
// no water passed, the cylinder was 4 mm above the bed after 0.4 s, and stayed there.
TEST(FloatingBody, ComesOutOfTheCornerOfBedAndSideWall) {
  constexpr double R = 0.125;
  const double displaced = std::numbers::pi * R * R;
  EXPECT_GT(rise_from_bed(circle(48, R, {R, R}), displaced, 2.0 * R, R / 5.0, R), R / 5.0);
}

// A box half as heavy as water, on the bed under twice its height of water. It rises and heaves about its draught: the
// mean over the last two of its periods of about 0.7 s is that of Archimedes.
TEST(FloatingBody, ComesUpFromTheBedToItsDraught) {
  constexpr double dx = 0.025;
  CaseSpec spec = tank_case<2>(dx, 1.2, 0.3);
  add_box(spec, {0.4, 0.0}, {0.8, 0.2}, 500.0);
  spec.bodies[0].free = {"y"};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  double water = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i)) water += flow.state.particles.volume[i];
  }
  constexpr double from = 2.6;
  double duration = 0.0;
  double sum = 0.0;
  while (flow.state.time < 4.0) {
    const double dt = step(flow).dt;
    if (flow.state.time < from) continue;
    duration += dt;
    sum += dt * (flow.state.motion.bodies.each[0].centre[1] - 0.1);
  }
  const double draught = (water + 0.4 * 0.1) / 1.2 - sum / duration;
  EXPECT_NEAR(draught, 0.1, 0.2 * dx);
}

// A box sinks onto a film of two rows and dams the inflow, until it floats on the water that has run over it. Until
// then it hovers at a height where a row of particles just does not fit. The time of lift-off is random: 3.5 to 4.6 s
// in nine runs (on the lattice, and with jitter 0.001 and 0.1 dx). Afterwards the box heaves with a period of 1 s about
// its draught of 0.1 m. Its mean over the last period equals that of Archimedes to a spacing. In those runs it was
// 0.009 to 0.0125 m lower, and the difference decreases as the waves decay. A box that lies on its film would be 0.2 m
// lower, and water that it compresses would be too dense by 10 % and more.
TEST(FloatingBody, FloatsOffAFilmAsTheWaterRises) {
  constexpr double dx = 0.02;
  CaseSpec spec = tank_case<2>(dx, 1.2, 0.3);
  spec.fluid[0].max[1] = 2.0 * dx;
  open_start(spec).discharge = 0.05;
  add_box(spec, {0.4, dx}, {0.8, dx + 0.2}, 500.0);
  spec.bodies[0].free = {"y"};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const BodyState<2>& body = flow.state.motion.bodies.each[0];
  const auto bottom = [&] { return body.centre[1] - 0.1; };
  const double length = 1.2 + flow.walls.boundary.ducts[0].length;  // length of the water's surface
  const auto bottom_at_rest = [&] { return (1.2 * 2.0 * dx + 0.05 * flow.state.time + 0.4 * 0.1) / length - 0.1; };
  double lowest = dx;
  double duration = 0.0;
  double sum = 0.0;
  while (flow.state.time < 6.4) {
    const double before = flow.state.time;
    pass_and_step(flow);
    lowest = std::min(lowest, bottom());
    ASSERT_GT(bottom(), -1e-9) << "t = " << flow.state.time;
    if (before < 5.4) continue;
    duration += flow.state.time - before;
    sum += (flow.state.time - before) * (bottom() - bottom_at_rest());
  }
  EXPECT_LT(lowest, 1e-9);
  EXPECT_NEAR(sum / duration, 0.0, dx);
  EXPECT_NEAR(measure(flow).density_error_mean, 0.0, 0.02);
}

// In the air beside a tank. The step is that of the water, and the errors are of first order in time.
TEST(FloatingBody, FallsFreelyAndSwingsOnALine) {
  constexpr double dx = 0.05;
  CaseSpec spec = tank_case<2>(dx, 0.4, 0.2);
  add_box(spec, {2.0, 5.0}, {2.2, 5.2}, 500.0);
  {
    Flow<2> flow = make_flow<2>(spec);
    double longest = 0.0;
    while (flow.state.time < 0.3) longest = std::max(longest, step(flow).dt);
    const BodyState<2>& body = flow.state.motion.bodies.each[0];
    const double t = flow.state.time;
    EXPECT_NEAR(body.velocity[1], -g * t, 1e-9);
    EXPECT_NEAR(body.centre[1], 5.1 - 0.5 * g * t * t, 0.5 * g * t * longest * 1.001);
  }
  // A spring of zero length, fastened to the centre, so stiff that the period is 0.5 s.
  const double mass = spec.bodies[0].mass;
  const double omega = 2.0 * std::numbers::pi / 0.5;
  spec.bodies[0].free = {"x"};
  MooringTable line;
  line.name = "line";
  line.bodies = {"hull"};
  line.at = {2.1, 5.1};
  line.anchor = {2.0, 5.1};
  line.stiffness = mass * omega * omega;
  spec.moorings = {line};
  Flow<2> flow = make_flow<2>(spec);
  double longest = 0.0;
  while (flow.state.time < 0.5) longest = std::max(longest, step(flow).dt);
  const double expected = 2.0 + 0.1 * std::cos(omega * flow.state.time);
  EXPECT_NEAR(flow.state.motion.bodies.each[0].centre[0], expected, 0.1 * omega * longest);
}

// In the air beside a tank: two boxes collide, and a piston collides with both. They do not rebound. After each
// collision they move with the velocity that follows from their momentum, or with that of the piston, and touch to
// rounding.
TEST(FloatingBody, MeetsOthersWithoutPassingOrRebounding) {
  CaseSpec spec = tank_case<2>(0.05, 0.4, 0.2);
  add_box(spec, {2.0, 5.0}, {2.2, 5.2}, 500.0, "a");
  add_box(spec, {2.4, 5.1}, {2.6, 5.3}, 1000.0, "b");
  for (BodyTable& body : spec.bodies) body.free = {"x"};
  spec.bodies[0].velocity = {1.0, 0.0};
  spec.bodies[1].velocity = {-0.2, 0.0};
  WallTable piston;
  piston.name = "piston";
  piston.shape = WallShape::box;
  piston.min = {1.6, 4.9};
  piston.max = {1.9, 5.3};
  piston.fluid_side = FluidSide::outside;
  piston.displacement = {"0.5*t", 0.0};
  spec.walls.push_back(piston);
  Flow<2> flow = make_flow<2>(spec);
  const std::vector<BodyState<2>>& bodies = flow.state.motion.bodies.each;
  const auto gap = [&] { return bodies[1].centre[0] - bodies[0].centre[0] - 0.2; };
  const double common = (500.0 * 1.0 - 1000.0 * 0.2) / 1500.0;
  const auto advance_to = [&](double end) {
    while (flow.state.time < end) {
      step(flow);
      ASSERT_GT(gap(), -1e-9) << "t = " << flow.state.time;
    }
  };
  advance_to(0.25);
  EXPECT_NEAR(gap(), 0.0, 1e-9);
  EXPECT_NEAR(bodies[0].velocity[0], common, 1e-9);
  EXPECT_NEAR(bodies[1].velocity[0], common, 1e-9);
  advance_to(1.5);
  EXPECT_NEAR(bodies[0].velocity[0], 0.5, 1e-9);
  EXPECT_NEAR(bodies[1].velocity[0], 0.5, 1e-9);
  EXPECT_NEAR(bodies[0].centre[0] - 0.1 - (1.9 + 0.5 * flow.state.time), 0.0, 1e-9);
}

// Two barges drift together in a basin and do not overlap.
TEST(FloatingBody, MeetsAnotherInTheWater) {
  constexpr double dx = 0.05;
  CaseSpec spec = tank_case<2>(dx, 2.0, 0.4);
  add_box(spec, {0.4, 0.3}, {0.8, 0.5}, 500.0, "a");
  add_box(spec, {1.1, 0.3}, {1.5, 0.5}, 500.0, "b");
  for (BodyTable& body : spec.bodies) body.free = {"x", "y"};
  spec.bodies[0].velocity = {0.8, 0.0};
  spec.bodies[1].velocity = {-0.8, 0.0};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const std::vector<BodyState<2>>& bodies = flow.state.motion.bodies.each;
  double least = 1.0;
  while (flow.state.time < 1.0) {
    step(flow);
    least = std::min(least, bodies[1].centre[0] - bodies[0].centre[0] - 0.4);
    ASSERT_GT(least, -1e-9) << "t = " << flow.state.time;
  }
  EXPECT_LT(least, dx);  // they have met
}

// A line between two boxes in free fall. The boxes fall as one and oscillate about each other at the frequency of their
// reduced mass, with errors of first order in the step.
TEST(FloatingBody, IsTiedToAnotherByALine) {
  CaseSpec spec = tank_case<2>(0.05, 0.4, 0.2);
  add_box(spec, {2.0, 5.0}, {2.2, 5.2}, 500.0, "a");
  add_box(spec, {3.0, 5.0}, {3.2, 5.2}, 1000.0, "b");
  for (BodyTable& body : spec.bodies) body.free = {"x", "y"};
  const double m_a = spec.bodies[0].mass;
  const double m_b = spec.bodies[1].mass;
  const double omega = 2.0 * std::numbers::pi / 0.8;
  MooringTable line;
  line.name = "line";
  line.bodies = {"a", "b"};
  line.at = {2.1, 5.1};
  line.anchor = {3.1, 5.1};
  line.length = 0.9;
  line.stiffness = omega * omega / (1.0 / m_a + 1.0 / m_b);
  spec.moorings = {line};
  Flow<2> flow = make_flow<2>(spec);
  const std::vector<BodyState<2>>& bodies = flow.state.motion.bodies.each;
  double longest = 0.0;
  while (flow.state.time < 0.2) longest = std::max(longest, step(flow).dt);  // a quarter of a period
  EXPECT_NEAR(m_a * bodies[0].velocity[0] + m_b * bodies[1].velocity[0], 0.0, 1e-9 * m_a);
  EXPECT_NEAR(bodies[0].velocity[1], -g * flow.state.time, 1e-9);
  const double expected = 0.9 + 0.1 * std::cos(omega * flow.state.time);
  EXPECT_NEAR(bodies[1].centre[0] - bodies[0].centre[0], expected, 0.1 * omega * longest);
}

// A line whose damping is a million times the limit of an explicit step. It lowers its body at the speed at which the
// weight stretches the line, m g/c, without oscillations.
TEST(FloatingBody, HangsOnALineOfAnyDamping) {
  CaseSpec spec = tank_case<2>(0.05, 0.4, 0.2);
  add_box(spec, {2.0, 5.0}, {2.2, 5.2}, 500.0);
  spec.bodies[0].free = {"x", "y"};
  MooringTable line;
  line.name = "line";
  line.bodies = {"hull"};
  line.at = {2.1, 5.1};
  line.anchor = {2.1, 6.1};
  line.length = 1.05;
  line.stiffness = 50.0;
  line.damping = 1e9;
  spec.moorings = {line};
  Flow<2> flow = make_flow<2>(spec);
  while (flow.state.time < 0.3) step(flow);
  const BodyState<2>& body = flow.state.motion.bodies.each[0];
  EXPECT_NEAR(body.centre[1], 5.05, 0.01);  // fallen until the line is straight, to the displacement in a step
  EXPECT_NEAR(body.velocity[1], -spec.bodies[0].mass * g / line.damping, 1e-7);
}

/// Height [m] of a box that is half as heavy as water, 0.15 s after it is let go a spacing above its draught.
double height_of_box(const CaseSpec& tank) {
  CaseSpec spec = tank;
  add_box(spec, {0.1, 0.25}, {0.3, 0.45}, 500.0);
  spec.bodies[0].free = {"y"};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 0.15) {
    adapt(flow);
    step(flow);
  }
  return flow.state.motion.bodies.each[0].centre[1];
}

TEST(FloatingBody, MovesInAZoneOfFinerParticlesAsInAFineRun) {
  CaseSpec spec = tank_case<2>(0.025, 0.9, 0.325);
  RefinementTable zone;
  zone.min = {-1.0, -1.0};
  zone.max = {0.55, 9.0};  // the border is 6 dx from the box
  spec.refinement = {zone};
  const double in_zone = height_of_box(spec);
  spec.refinement.clear();
  const double coarse = height_of_box(spec);
  spec.particles.spacing = 0.0125;
  const double fine = height_of_box(spec);
  EXPECT_NEAR(in_zone, fine, 0.05 * (0.35 - fine)) << "coarse: " << coarse;
  EXPECT_GT(std::abs(coarse - fine), 2.0 * std::abs(in_zone - fine));
}

}  // namespace
}  // namespace tailwater
