// Forces on walls: the momentum that the water loses to them, the force on each wall, and the work of moving walls.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "air/enclosed_air.h"
#include "base/error.h"
#include "flow/stages.h"
#include "geometry/cases.h"
#include "pressure/stages.h"
#include "schemes/float_boxes.h"
#include "schemes/force_reader.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

using testing_cases::box_fluid;
using testing_cases::box_wall;
using testing_cases::empty_case;

/// Relative round-off of sums of 1e5 pair forces, each up to 1e2 times a particle's weight. The reference is the total
/// weight of at least 1e2 particles: eps 1e5 1e2/1e2, and ten times that.
constexpr double rounding = 2e-10;

template <class D>
class WallForceOfAir : public testing::Test {};
TYPED_TEST_SUITE(WallForceOfAir, Dimensions);

template <int Dim>
struct Momentum {
  double mass = 0.0;
  Vec<Dim> linear = Vec<Dim>::Zero();
};

template <int Dim>
Momentum<Dim> momentum_of(const Flow<Dim>& flow) {
  Momentum<Dim> sum;
  const Particles<Dim>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double mass = flow.setup.liquid.density * particles.volume[i];
    sum.mass += mass;
    sum.linear += mass * particles.velocity[i];
  }
  return sum;
}

/// Whether the last guard has kept water away from a wall in this step.
template <int Dim>
bool has_contact(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  return count_each(particles.owned, [&](std::size_t i) {
           return particles.is_fluid(i) && !flow.walls.forces.pressure[i].isZero(0.0);
         }) > 0;
}

struct Scheme {
  const char* name;
  void (*choose)(CaseSpec& spec);
};

std::ostream& operator<<(std::ostream& out, const Scheme& scheme) { return out << scheme.name; }

const Scheme schemes[] = {
    {"explicit", [](CaseSpec& spec) { spec.scheme.integrator = Integrator::explicit_projection; }},
    {"implicit", [](CaseSpec& spec) { spec.scheme.integrator = Integrator::implicit_projection; }},
    {"two_step",
     [](CaseSpec& spec) {
       spec.scheme.name = SchemeName::farmani2020;
       apply_formulation(spec.scheme);
     }},
    {"two_step_as_published",
     [](CaseSpec& spec) {
       spec.scheme.name = SchemeName::farmani2020;
       spec.scheme.formulation = Formulation::published;
       apply_formulation(spec.scheme);
     }},
};

class WallForce : public testing::TestWithParam<Scheme> {};

/// Water that falls onto the bed of its tank, slips along it and rises at the walls.
template <int Dim>
void expect_balance_of_momentum(const Scheme& scheme, double dx, double width, double depth, int steps) {
  CaseSpec spec = tank_case<Dim>(dx, width, depth);
  spec.walls[0].slip = Slip::no_slip;
  spec.fluid[0].velocity = VectorField(Dim, 0.0);
  spec.fluid[0].velocity[0] = 0.6;
  spec.fluid[0].velocity[Dim - 1] = -1.5;
  scheme.choose(spec);
  spec.probes = {force_probe(Coordinates(Dim, 0.0))};
  Flow<Dim> flow = make_flow<Dim>(spec);
  const Reader<Dim> probe(spec, flow);
  Vec<Dim> largest = Vec<Dim>::Zero();
  bool any_contact = false;
  for (int n = 0; n < steps; ++n) {
    const Momentum<Dim> before = momentum_of(flow);
    const double dt = step(flow).dt;
    const Momentum<Dim> after = momentum_of(flow);
    const Vec<Dim> force = probe.force(dt);
    const Vec<Dim> lost = after.mass * flow.setup.gravity - (after.linear - before.linear) / dt;
    const double scale = std::max(after.mass * g, force.norm());
    const double tolerance = flow.walls.forces.balanced.empty() ? rounding : 0.01;  // of the balanced pressure
    ASSERT_LE((force - lost).norm(), tolerance * scale) << "step " << n << ": " << force.transpose();
    largest = largest.cwiseMax(force.cwiseAbs());
    any_contact = any_contact || has_contact(flow);
  }
  // The balance has significant terms, since the walls stop the water.
  EXPECT_GT(largest[Dim - 1], 2.0 * momentum_of(flow).mass * g);
  EXPECT_GT(largest[0], 0.1 * momentum_of(flow).mass * g);
  // Water does not touch a wall with a row of particles that take part in the pressure equation.
  EXPECT_EQ(any_contact, spec.scheme.formulation == Formulation::robust);
}

TEST_P(WallForce, IsWhatTheMomentumLosesInATank) { expect_balance_of_momentum<2>(GetParam(), 0.05, 1.0, 0.4, 40); }

INSTANTIATE_TEST_SUITE_P(Schemes, WallForce, testing::ValuesIn(schemes),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

TEST(WallForce3D, IsWhatTheMomentumLosesInASmallBox) {
  for (const int k : {0, 1}) expect_balance_of_momentum<3>(schemes[k], 0.1, 0.6, 0.4, 12);
}

/// Three walls of a tank, and the water in it.
CaseSpec tank_of_three_walls(double dx, double width, double depth) {
  CaseSpec spec = tank_case<2>(dx, width, depth);
  const double high = 2.0 * depth;
  const std::vector<std::pair<std::string, std::vector<Coordinates>>> chains{{"left", {{0.0, high}, {0.0, 0.0}}},
                                                                             {"bed", {{0.0, 0.0}, {width, 0.0}}},
                                                                             {"right", {{width, 0.0}, {width, high}}}};
  spec.walls.clear();
  for (const auto& [name, points] : chains) {
    WallTable wall;
    wall.name = name;
    wall.points = points;
    wall.slip = Slip::no_slip;
    spec.walls.push_back(wall);
  }
  return spec;
}

TEST(WallForceParts, AddUpToTheWholeAndMomentsToo) {
  CaseSpec spec = tank_of_three_walls(0.05, 1.0, 0.4);
  spec.fluid[0].velocity = {0.5, -0.5};
  const Coordinates about{0.3, 0.2};
  spec.probes = {force_probe(about)};
  for (const WallTable& wall : spec.walls) spec.probes.push_back(force_probe(about, {wall.name}));
  // The bed again, in two parts whose border lies within patches.
  for (const bool is_left : {true, false}) {
    ProbeTable part = force_probe(about, {"bed"});
    part.region_min = {is_left ? -0.1 : 0.437, -0.1};
    part.region_max = {is_left ? 0.437 : 1.1, 0.1};
    spec.probes.push_back(part);
  }
  Flow<2> flow = make_flow<2>(spec);
  for (int n = 0; n < 5; ++n) step(flow);
  const auto row = [&](std::size_t probe) { return Reader<2>(spec, flow, probe).row(0.0); };
  const Row whole = row(0);
  const Row left = row(1), bed = row(2), right = row(3), bed_left = row(4), bed_right = row(5);
  ASSERT_EQ(whole.size(), 7u);
  const double scale = Vec<2>::Map(whole.data()).norm();
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_NEAR(left[k] + bed[k] + right[k], whole[k], rounding * scale) << k;
    EXPECT_NEAR(bed_left[k] + bed_right[k], bed[k], rounding * scale) << k;
  }
  for (const std::size_t k : {0, 1}) EXPECT_NEAR(whole[2 + k] + whole[4 + k], whole[k], rounding * scale) << k;
  EXPECT_NE(whole[4], 0.0);  // friction
}

/// Every wall of a full box has the force p times its length, for any neighbours. The force through the wall particles
/// behind a corner, p <r>/pi in each direction (docs/theory/probes.md), goes to the wall across which it acts. One
/// remaining error is the kernel's quadrature, 0.0125 at most (its error of the first moment of a lattice). The other
/// is the fraction epsilon of the force that acts behind both corners.
TEST(WallForceParts, AUniformPressureGivesEachWallItsShare) {
  const double dx = 0.1;
  const double width = 1.0;
  const double p = 3000.0;
  CaseSpec spec = tank_of_three_walls(dx, width, width);
  WallTable lid;
  lid.name = "lid";
  lid.points = {{width, width}, {0.0, width}};
  spec.walls[0].points[0][1] = spec.walls[2].points[1][1] = width;
  spec.walls.push_back(lid);
  const Coordinates about{0.0, 0.0};
  for (const WallTable& wall : spec.walls) spec.probes.push_back(force_probe(about, {wall.name}));
  Flow<2> flow = make_flow<2>(spec);
  locate(flow);
  flow.walls.forces.reset(flow.state.particles.owned);
  add_wall_forces(flow, std::vector<double>(flow.state.particles.size(), p));
  const Vec<2> outwards[] = {{-1.0, 0.0}, {0.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};
  for (std::size_t wall = 0; wall < 4; ++wall) {
    const Reader<2> probe(spec, flow, wall);
    const Vec<2> expected = p * width * outwards[wall];
    EXPECT_LE((probe.force() - expected).norm(), 0.0125 * p * width) << spec.walls[wall].name;
    // The force acts in the middle of its wall; moments are about a corner of the box.
    const double arm = wall == 0 || wall == 3 ? 0.5 * width : -0.5 * width;
    EXPECT_NEAR(probe.row(0.0)[6], p * width * arm, 0.0125 * p * width * width) << spec.walls[wall].name;
  }
}

/// A cylinder or a tilted square, 30 dx across, in water at rest: the force is the weight of the displaced water. With
/// 20 dx the square's is 0.6 to 1.1 % low, depending on its place between the particles.
void expect_buoyancy(const std::vector<Coordinates>& outline, double area) {
  const double dx = 1.0 / 30.0;
  CaseSpec spec = tank_case<2>(dx, 54.0 * dx, 54.0 * dx);
  WallTable body;
  body.name = "body";
  body.shape = WallShape::polygon;
  body.points = outline;
  body.fluid_side = FluidSide::outside;
  spec.walls.push_back(body);
  spec.probes = {force_probe({0.0, 0.0}, {"body"}), force_probe({0.0, 0.0})};
  Flow<2> flow = make_flow<2>(spec);
  const Reader<2> on_body(spec, flow, 0);
  const Reader<2> on_all(spec, flow, 1);
  double impulse = 0.0;
  double mean_all = 0.0;
  Vec<2> mean = Vec<2>::Zero();
  for (int n = 0; n < 60; ++n) {
    const double dt = step(flow).dt;
    impulse += dt;
    mean += dt * on_body.force(dt);
    mean_all += dt * on_all.force(dt)[1];
  }
  mean /= impulse;
  const double weight = flow.setup.liquid.density * g * area;
  EXPECT_NEAR(mean[1], weight, 0.01 * weight);
  EXPECT_NEAR(mean[0], 0.0, 0.01 * weight);
  // All walls together carry the water.
  EXPECT_NEAR(-mean_all / impulse, momentum_of(flow).mass * g, 0.01 * weight);
}

TEST(Buoyancy, OfACylinder) {
  std::vector<Coordinates> outline;
  constexpr int corners = 120;
  const double radius = 0.5;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / corners;
    outline.push_back({0.9 + radius * std::cos(angle), 0.85 + radius * std::sin(angle)});
  }
  expect_buoyancy(outline, 0.5 * corners * radius * radius * std::sin(2.0 * std::numbers::pi / corners));
}

TEST(Buoyancy, OfATiltedSquare) {
  std::vector<Coordinates> outline;
  const double half = 0.5;
  const double tilt = 0.4;
  for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
    outline.push_back({0.9 + x * std::cos(tilt) - y * std::sin(tilt), 0.85 + x * std::sin(tilt) + y * std::cos(tilt)});
  }
  expect_buoyancy(outline, 4.0 * half * half);
}

/// A hull of this outline in a tank with still water, 24 by 20 dx. Returns its lift, the force on it across and the
/// force on all walls over the weight of the water that the hull displaces, on average over the second half of 40
/// steps. With `zone` the tank is twice as long, and finer from there [m] on.
struct Lift {
  double hull = 0.0;
  double across = 0.0;
  double all = 0.0;
};
Lift lift_of(const std::vector<Coordinates>& outline, double area, double dx, double zone = 0.0) {
  CaseSpec spec = tank_case<2>(dx, (zone > 0.0 ? 48.0 : 24.0) * dx, 20.0 * dx);
  if (zone > 0.0) {
    RefinementTable finer;
    finer.min = {zone, -1.0};
    finer.max = {100.0 * dx, 100.0 * dx};
    spec.refinement = {finer};
  }
  WallTable hull;
  hull.name = "hull";
  hull.shape = WallShape::polygon;
  hull.fluid_side = FluidSide::outside;
  hull.points = outline;
  spec.walls.push_back(hull);
  spec.probes = {force_probe({0.0, 0.0}, {"hull"}), force_probe({0.0, 0.0})};
  Flow<2> flow = make_flow<2>(spec);
  const Reader<2> on_hull(spec, flow, 0), on_all(spec, flow, 1);
  const double weight = flow.setup.liquid.density * g * area;
  Lift mean;
  const int steps = zone > 0.0 ? 80 : 40;  // of half the length
  for (int n = 0; n < steps; ++n) {
    const double dt = step(flow).dt;
    if (n < steps / 2) continue;
    mean.hull += on_hull.force(dt)[1] / weight * 2.0 / steps;
    mean.across += on_hull.force(dt)[0] / weight * 2.0 / steps;
    mean.all += (on_all.force(dt)[1] / weight + momentum_of(flow).mass * g / weight) * 2.0 / steps;
  }
  return mean;
}

/// A pipe 10 dx across, `gap` [dx] above the bed and `centre` [m] from the side wall.
Lift lift_of_pipe(double gap, double turn, double dx, double centre, double zone = 0.0) {
  constexpr int corners = 48;
  const double radius = 5.0 * dx;
  std::vector<Coordinates> outline;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + turn) / corners;
    const double bottom = std::cos(turn * 2.0 * std::numbers::pi / corners);  // of the lowest corner, over the radius
    outline.push_back({centre + radius * std::sin(angle), gap * dx + radius * (bottom - std::cos(angle))});
  }
  return lift_of(outline, 0.5 * corners * radius * radius * std::sin(2.0 * std::numbers::pi / corners), dx, zone);
}

/// On the bed the pipe has the lift of Archimedes, because water reaches all of its surface up to the line of contact,
/// whether a corner or a side of its outline is there. The pairs alone give less than a fifth of it.
TEST(Buoyancy, OfAPipeOnTheBed) {
  constexpr double dx = 1.0 / 30.0;
  for (const auto& [gap, turn] : {std::pair{0.0, 0.0}, {0.0, 0.5}, {0.5, 0.0}, {1.0, 0.0}, {2.0, 0.0}}) {
    const Lift lift = lift_of_pipe(gap, turn, dx, 12.0 * dx);
    EXPECT_NEAR(lift.hull, 1.0, 0.03) << gap << " " << turn;
    EXPECT_NEAR(lift.all, 0.0, 0.01) << gap << " " << turn;  // the walls carry the water
  }
}

/// A zone that leaves the spacing within the reach of the pipe alone does not matter.
TEST(Buoyancy, OfAPipeOnTheBedBeforeAZoneOfRefinement) {
  constexpr double dx = 1.0 / 30.0;
  EXPECT_NEAR(lift_of_pipe(0.0, 0.5, dx, 12.0 * dx, 23.0 * dx).hull, 1.0, 0.03);
}

/// Each of two blocks beside each other has its force from the integral over its surface. A probe on all walls crashed.
TEST(Buoyancy, OfTwoBlocksBesideEachOther) {
  constexpr double dx = 1.0 / 30.0;
  CaseSpec spec = tank_case<2>(dx, 30.0 * dx, 20.0 * dx);
  for (const double left : {6.0 * dx, 16.0 * dx}) {
    WallTable block = box_wall({left, 6.0 * dx}, {left + 8.0 * dx, 14.0 * dx}, {}, FluidSide::outside);
    block.name = left < 10.0 * dx ? "one" : "other";
    spec.walls.push_back(block);
  }
  spec.probes = {force_probe({0.0, 0.0})};
  Flow<2> flow = make_flow<2>(spec);
  const Reader<2> on_all(spec, flow);
  double lift = 0.0;
  constexpr int steps = 20;
  for (int n = 0; n < steps; ++n) lift += on_all.force(step(flow).dt)[1] / steps;
  EXPECT_NEAR(lift / (momentum_of(flow).mass * g), -1.0, 0.02);
}

/// A pipe that touches bed and side wall seals the water between them. Films give it the head of the water around. The
/// density source alone gave the pipe 14 times its lift.
TEST(Buoyancy, OfAPipeInTheCorner) {
  constexpr double dx = 1.0 / 30.0;
  const Lift lift = lift_of_pipe(0.0, 0.0, dx, 5.0 * dx);
  EXPECT_NEAR(lift.hull, 1.0, 0.03);
  EXPECT_NEAR(lift.across, 0.0, 0.05);
}

/// An octagon that lies flat on bed and side wall. Both contacts are dry, and the water between them has the head of
/// the water around, which seeps through. Before, its pressure came and went: a lift of -0.4 to 8.
TEST(Buoyancy, OfAnOctagonFlatInTheCorner) {
  constexpr double dx = 1.0 / 30.0, depth = 20.0 * dx, radius = 5.0 * dx;
  const double half_side = radius * std::tan(std::numbers::pi / 8.0);
  std::vector<Coordinates> outline;
  for (const auto& [x, y] : {std::pair{radius, half_side}, {half_side, radius}}) {
    outline.insert(outline.end(), {{x, y}, {-x, y}, {-x, -y}, {x, -y}});
  }
  std::ranges::sort(outline, {}, [](const Coordinates& corner) { return std::atan2(corner[1], corner[0]); });
  for (Coordinates& corner : outline) corner = {radius + corner[0], radius + corner[1]};
  const double area = 8.0 * radius * half_side, dry = 2.0 * half_side;
  const Lift lift = lift_of(outline, area, dx);
  EXPECT_NEAR(lift.hull, 1.0 - depth * dry / area, 0.05);
  EXPECT_NEAR(lift.across, -(depth - radius) * dry / area, 0.05);
}

/// A block 10 dx wide with a flat bottom above the bed. Two rows of particles squeezed into a gap of 1.5 dx have too
/// high a pressure, as have those beside a gap that they cannot enter. The lift was 5 % too large.
TEST(Buoyancy, OfABlockAboveTheBed) {
  constexpr double dx = 1.0 / 30.0;
  const double left = 7.0 * dx, right = 17.0 * dx;
  for (const double gap : {0.3, 1.5}) {
    const double low = gap * dx, high = low + 8.0 * dx;
    const Lift lift = lift_of({{left, low}, {right, low}, {right, high}, {left, high}}, 80.0 * dx * dx, dx);
    EXPECT_NEAR(lift.hull, 1.0, 0.03) << gap;
  }
}

/// Gaps of a pipe to bed and side wall into which no particle fits.
TEST(Buoyancy, OfAPipeNearTheCorner) {
  constexpr double dx = 1.0 / 30.0;
  for (const auto& [below, beside] : {std::pair{0.3, 0.4}, {0.4, 0.3}}) {
    const Lift lift = lift_of_pipe(below, 0.0, dx, (5.0 + beside) * dx);
    EXPECT_NEAR(lift.hull, 1.0, 0.03) << below;
    EXPECT_NEAR(lift.across, 0.0, 0.03) << below;
  }
}

/// A piston compresses the water of a tank horizontally. Its work is the rise of the energy plus the dissipation, which
/// is the viscous work of the energy balance.
TEST(WallForceOfAPiston, ItsPowerIsTheWorkOnTheWater) {
  const double dx = 0.05;
  CaseSpec spec = tank_of_three_walls(dx, 1.0, 0.5);
  spec.walls[0].displacement = {"0.1*(1 - cos(pi*clamp(t/2, 0, 1)))", 0.0};
  spec.walls[0].slip = Slip::free;
  spec.walls[1].points[0][0] = -0.3;
  spec.probes = {force_probe({0.0, 0.0}, {"left"})};
  Flow<2> flow = make_flow<2>(spec);
  const Reader<2> probe(spec, flow);
  const double start = fluid_sums_of_rank(flow).energy;
  double work = 0.0;
  double booked = 0.0;
  double lost = 0.0;
  while (flow.state.time < 2.0) {
    const StepReport report = step(flow);
    work += report.dt * probe.power(report.dt);
    booked += report.work.walls;
    lost -= report.work.viscous;
  }
  const double rise = fluid_sums_of_rank(flow).energy - start;
  EXPECT_GT(rise, 50.0);
  EXPECT_NEAR(work, rise + lost, 0.05 * rise);
  // The energy balance omits the part that acts through the bed's particles below the piston.
  EXPECT_NEAR(work, booked, 0.1 * rise);
}

constexpr double half_of_turning_tank = 0.3;

/// Water that turns with its tank.
CaseSpec turning_tank() {
  constexpr double dx = 0.05, half = half_of_turning_tank;
  CaseSpec spec = tank_case<2>(dx, 2.0 * half, 2.0 * half);
  spec.physics.gravity = {0.0, 0.0};
  spec.walls[0].open.clear();
  spec.walls[0].min = {-half, -half};
  spec.walls[0].max = {half, half};
  spec.walls[0].name = "tank";
  spec.walls[0].rotation = "3*t";
  spec.walls[0].pivot = {0.0, 0.0};
  spec.fluid[0].min = spec.walls[0].min;
  spec.fluid[0].max = spec.walls[0].max;
  spec.fluid[0].velocity = {"-3*y", "3*x"};
  return spec;
}

/// Water that turns with a closed tank has its pressure of w^2 r^2/2 on all walls, whose moment is 0. The forces act
/// where the walls are when the step begins: at its end they would have a moment of w dt times the integral of p r.n.
void expect_no_moment_and_no_work(Integrator integrator) {
  constexpr double half = half_of_turning_tank;
  CaseSpec spec = turning_tank();
  spec.scheme.integrator = integrator;
  spec.probes = {force_probe({0.0, 0.0}, {"tank"})};
  Flow<2> flow = make_flow<2>(spec);
  const Reader<2> probe(spec, flow);
  start(flow);
  double moment = 0.0, power = 0.0, work = 0.0, at_end = 0.0;
  for (int n = 0; n < 20; ++n) {
    const StepReport report = step(flow);
    const double dt = report.dt;
    if (n < 10) continue;
    power += probe.power(dt) / 10.0;
    work += report.work.walls / dt / 10.0;
    moment += probe.row(dt)[6] / 10.0;
    at_end += 3.0 * dt * spec.physics.density * 9.0 * 16.0 / 3.0 * std::pow(half, 4) / 10.0;
  }
  EXPECT_LT(std::abs(moment), 0.1 * at_end);
  EXPECT_LT(std::abs(power), 0.1 * 0.5 * 3.0 * at_end);  // by the velocity of the walls in the step: half of w M
  EXPECT_LT(std::abs(work), 0.1 * 0.5 * 3.0 * at_end);
}

TEST(WallForceOfATurningTank, HasNoMomentAndDoesNoWork) {
  expect_no_moment_and_no_work(Integrator::explicit_projection);
}

/// Half of the pressure acts where the step ends.
TEST(WallForceOfATurningTank, HasNoMomentAndDoesNoWorkWithTheImplicitIntegrator) {
  expect_no_moment_and_no_work(Integrator::implicit_projection);
}

/// A drum that turns in water at rest drags it: the power of its friction is the moment times the rate.
TEST(WallForceOfATurningTank, HasThePowerOfItsFriction) {
  CaseSpec spec = turning_tank();
  spec.fluid[0].velocity = {};
  spec.physics.viscosity = 0.01;
  spec.scheme.turbulence = Turbulence::none;
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].points = {};
  for (int k = 0; k <= 48; ++k) {
    const double angle = k % 48 * std::numbers::pi / 24.0;
    spec.walls[0].points.push_back({half_of_turning_tank * std::cos(angle), half_of_turning_tank * std::sin(angle)});
  }
  spec.walls[0].shape = WallShape::polyline;
  spec.walls[0].fluid_side = FluidSide::left;
  spec.fluid[0].shape = BlockShape::fill;
  spec.fluid[0].seed = {0.0, 0.0};
  spec.fluid[0].level = 2.0;
  spec.probes = {force_probe({0.0, 0.0}, {"tank"})};
  Flow<2> flow = make_flow<2>(spec);
  const Reader<2> probe(spec, flow);
  start(flow);
  double moment = 0.0, power = 0.0;
  for (int n = 0; n < 20; ++n) {
    const double dt = step(flow).dt;
    if (n < 2) continue;  // it starts
    power += probe.power(dt);
    moment += probe.row(dt)[6];
  }
  EXPECT_GT(power, 0.0);
  EXPECT_NEAR(power, -3.0 * moment, 0.01 * power);
}

TEST(WallForceRefuses, SchemesWithoutReactions) {
  CaseSpec spec = tank_case<2>(0.1, 1.0, 0.5);
  spec.probes = {force_probe({0.0, 0.0})};
  spec.scheme.formulation = Formulation::published;
  const Boundary<2> boundary = make_boundary<2>(spec);
  try {
    force_reading<2>(spec.probes[0], spec, boundary);
    FAIL() << "the consistent gradient has no reactions";
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* part : {"probe 'force'", "scheme.formulation", "\"robust\""}) {
      EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }
}

TEST(WallForce, HasNoMomentWithoutAPointForIt) {
  CaseSpec spec = tank_case<2>(0.1, 0.5, 0.3);
  spec.probes = {force_probe({})};
  const Flow<2> flow = make_flow<2>(spec);
  const Reading<2> reading = force_reading<2>(spec.probes[0], spec, flow.walls.boundary);
  EXPECT_EQ(reading.columns.size(), 6U);  // force, pressure, friction
  for (const OutputColumn& column : reading.columns) EXPECT_NE(column.measure, Measure::moment) << column.name;
}

// A column of water falls onto a closed column of air. The floor, which is in contact with the air only, carries its
// pressure.
TYPED_TEST(WallForceOfAir, IsItsPressureTimesTheArea) {
  constexpr int Dim = TypeParam::value;
  constexpr double width = 0.4;
  CaseSpec spec = tank_case<Dim>(0.05, width, 0.8);
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.fluid[0].min[Dim - 1] = 0.5;
  spec.fluid[0].velocity = VectorField(Dim, 0.0);
  spec.fluid[0].velocity[Dim - 1] = -2.0;
  spec.air.pockets = AirPockets::adiabatic;
  ProbeTable floor = force_probe(Coordinates(Dim, 0.0));
  floor.region_min = Coordinates(Dim, -1.0);
  floor.region_max = Coordinates(Dim, 1.0);
  floor.region_max[Dim - 1] = 1e-6;
  spec.probes = {floor};
  Flow<Dim> flow = make_flow<Dim>(spec);
  start(flow);
  for (int n = 0; n < 5; ++n) step(flow);
  const double pressure = air_of(flow).measures().pressure;
  ASSERT_GT(std::abs(pressure), 100.0);
  const double expected = -pressure * std::pow(width, Dim - 1);
  EXPECT_NEAR(Reader<Dim>(spec, flow).force()[Dim - 1], expected, rounding * std::abs(expected));
}

/// Walls that start with an acceleration a push the mass m of water and body with m a, from the start on. The first
/// step of the explicit projection takes the water to mid-step only, and half of the inertia was missing in its force.
TEST(AcceleratedTank, HasItsWholeInertiaInTheFirstStep) {
  const double dx = 0.05;
  const double a = 0.25 * g;
  const Integrator with_one = Integrator::explicit_projection, with_two = Integrator::implicit_projection;
  for (const auto& [integrator, has_body] :
       {std::pair{with_one, false}, {with_one, true}, {with_two, false}, {with_two, true}}) {
    CaseSpec spec;
    spec.particles.spacing = dx;
    spec.scheme.integrator = integrator;
    WallTable tank;
    tank.name = "tank";
    tank.points = {{0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
    tank.displacement = {"0.125*g*t^2", 0.0};
    spec.walls = {tank};
    FluidTable water;  // the level in the accelerated frame
    water.shape = BlockShape::polygon;
    water.points = {{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.5}, {0.0, 0.75}};
    spec.fluid = {water};
    const double edge = 0.3;
    if (has_body) {
      const double mass = spec.physics.density * edge * edge;
      const Coordinates centre{0.35 + 0.5 * edge, 0.15 + 0.5 * edge};
      WallTable box;
      box.shape = WallShape::box;
      box.fluid_side = FluidSide::outside;
      box.min = {0.35, 0.15};
      box.max = {0.35 + edge, 0.15 + edge};
      box.name = "box";
      add_body(spec, box, body_of("box", mass, centre, {mass * edge * edge / 6.0}));
    }
    spec.probes = {force_probe({0.0, 0.0}, {"tank"})};
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    const double expected = -0.625 * spec.physics.density * a;  // of 0.625 m^2 of water or a body of its density
    for (int n = 0; n < 4; ++n) {
      EXPECT_NEAR(Reader<2>(spec, flow).force()[0], expected, 0.03 * std::abs(expected)) << n << ", " << has_body;
      step(flow);
    }
  }
}

// A plate across a slice of a wide tank goes on in the next periods. Where it seemed to end, water beside the periodic
// boundary felt the plate's particles of the other side, and the force was 4 to 5 % too large.
TEST(PlateAcrossAPeriodicSlice, HasTheForceOfStillWater) {
  constexpr double dx = 0.02, length = 0.2, width = 12.0 * dx, depth = 0.2;
  CaseSpec spec = empty_case(dx, 3);
  spec.domain.periodic_y = {0.0, width};
  WallTable bed = box_wall({0.0, 0.0, 0.0}, {2.0 * length, width, 2.0 * depth}, {"-y", "+y", "+z"});
  WallTable plate;
  plate.name = "plate";
  plate.shape = WallShape::plate;
  plate.points = {{length, 0.0, 0.0}, {length, width, 0.0}, {length, width, 0.3}, {length, 0.0, 0.3}};
  spec.walls = {bed, plate};
  spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {length, width, depth})};
  spec.probes = {force_probe({0.0, 0.0, 0.0}, {"plate"})};
  Flow<3> flow = make_flow<3>(spec);
  start(flow);
  const double expected = 0.5 * spec.physics.density * g * depth * depth * width;
  step(flow);  // the first pressures are a little low
  for (int n = 0; n < 10; ++n) {
    const double dt = step(flow).dt;
    EXPECT_NEAR(Reader<3>(spec, flow).force(dt)[0], expected, 0.01 * expected) << n;
  }
}

// Half of the forces on the side of the block that is beside the boundary act through particles of the next period.
TEST(BlockBesideAPeriodicBoundary, HasNoForceAlongThePeriod) {
  constexpr double dx = 0.1;
  CaseSpec spec = empty_case(dx);
  spec.domain.periodic_x = {0.0, 2.4};
  WallTable block = box_wall({0.5 * dx, 0.0}, {0.5 * dx + 0.4, 0.9}, {}, FluidSide::outside);
  block.name = "block";
  spec.walls = {testing_cases::polyline({{0.0, 0.0}, {2.4, 0.0}}), block};
  spec.fluid = {box_fluid({0.0, 0.0}, {2.4, 0.6})};
  spec.probes = {force_probe({0.0, 0.0}, {"block"})};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  step(flow);
  step(flow);
  const double side = 0.5 * spec.physics.density * g * 0.6 * 0.6;
  EXPECT_NEAR(Reader<2>(spec, flow).force()[0], 0.0, 0.05 * side);
}

// Neither the bed below the block nor the gap between them was found in the next period.
TEST(BlockMovingAcrossAPeriodicBoundary, StandsOnTheBedOfTheNextPeriod) {
  constexpr double dx = 0.1;
  CaseSpec spec = empty_case(dx);
  spec.domain.periodic_x = {0.0, 2.4};
  WallTable block = box_wall({1.9, 0.0}, {2.3, 0.9}, {}, FluidSide::outside);
  block.name = "block";
  block.displacement = {"t", 0.0};
  spec.walls = {testing_cases::polyline({{0.0, 0.0}, {2.4, 0.0}}), block};
  spec.fluid = {box_fluid({0.0, 0.0}, {2.4, 0.6})};
  spec.fluid[0].velocity = {1.0, 0.0};
  spec.probes = {force_probe({0.0, 0.0}, {"block"})};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const double below = spec.physics.density * g * 0.6 * 0.4;  // if water were there
  while (flow.state.time < 0.7) {
    step(flow);
    EXPECT_NEAR(Reader<2>(spec, flow).force()[1], 0.0, 0.02 * below) << flow.state.time;
  }
}

// Water stands on one side of a plate and compressed air on the other. Water on the far side counted as covering the
// side of the air, if the corners were drawn in one order.
TEST(PlateBetweenWaterAndAir, HasTheForceOfBothInAnyOrderOfItsCorners) {
  constexpr double dx = 0.04, height = 0.6, depth = 0.4, overpressure = 3000.0;
  for (const bool is_reversed : {false, true}) {
    CaseSpec spec = tank_case<2>(dx, 1.0, depth);
    spec.walls[0].max = {1.0, height};
    spec.walls[0].open = {};
    spec.fluid[0].max[0] = 0.5;
    WallTable plate;
    plate.name = "plate";
    plate.shape = WallShape::plate;
    plate.points = {{0.5, 0.0}, {0.5, height}};
    if (is_reversed) std::ranges::reverse(plate.points);
    spec.walls.push_back(plate);
    spec.air.pockets = AirPockets::isothermal;
    PocketTable air, beside;
    air.at = {0.8, 0.3};
    air.overpressure = overpressure;
    beside.at = {0.2, 0.5};
    spec.pockets = {air, beside};
    spec.probes = {force_probe({0.0, 0.0}, {"plate"})};
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    step(flow);
    step(flow);
    const double expected = 0.5 * spec.physics.density * g * depth * depth - overpressure * height;
    EXPECT_NEAR(Reader<2>(spec, flow).force()[0], expected, 0.03 * std::abs(expected)) << is_reversed;
  }
}

/// A block hangs from the lid of a sealed tank of air and is drawn on into the lid, where no air reaches the lid.
TEST(LidOverAir, HasNoForceBehindABlock) {
  constexpr double dx = 0.05, overpressure = 5000.0, width = 0.2;
  CaseSpec spec = tank_case<2>(dx, 1.0, 0.2);
  spec.walls[0].max = {1.0, 0.6};
  spec.walls[0].open = {};
  WallTable block;
  block.name = "block";
  block.shape = WallShape::box;
  block.fluid_side = FluidSide::outside;
  block.min = {0.41, 0.4};
  block.max = {0.41 + width, 0.6 + dx};
  spec.walls.push_back(block);
  spec.air.pockets = AirPockets::isothermal;
  PocketTable air;
  air.at = {0.1, 0.5};
  air.overpressure = overpressure;
  spec.pockets = {air};
  ProbeTable lid = force_probe({0.0, 0.0}, {"tank"});
  lid.region_min = {-1.0, 0.6 - 1e-6};
  lid.region_max = {2.0, 1.0};
  spec.walls[0].name = "tank";
  spec.probes = {lid, force_probe({0.0, 0.0}, {"block"})};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  step(flow);
  const double pressure = air_of(flow).measures().pressure;
  EXPECT_NEAR(pressure, overpressure, 0.01 * overpressure);
  EXPECT_NEAR(Reader<2>(spec, flow, 0).force()[1], (1.0 - width) * pressure, 0.25 * dx * pressure);  // a piece
  EXPECT_NEAR(Reader<2>(spec, flow, 1).force()[1], width * pressure, 0.25 * dx * pressure);
}

}  // namespace
}  // namespace tailwater
