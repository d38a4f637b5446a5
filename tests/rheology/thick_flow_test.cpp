// Flows of thick liquids against their exact solutions.
#include <gtest/gtest.h>

#include <numbers>

#include "flow/measure.h"
#include "rheology/liquids.h"
#include "rheology/thick_liquid.h"
#include "schemes/force_reader.h"
#include "support/circle.h"
#include "support/record.h"

namespace tailwater {
namespace {

constexpr double density = 1000.0;

void run_to(Flow<2>& flow, double end) {
  while (flow.state.time < end) step(flow);
}

/// Velocity of a film of depth 1 m under the force f [Pa/m] along its bed: the stress f (1 - y) shears it up to 1 -
/// t_y/f.
double film_velocity(double y, double f, double consistency, double index, double yield_stress) {
  const double sheared = 1.0 - yield_stress / f;
  const double m = 1.0 / index + 1.0;
  return std::pow(f / consistency, 1.0 / index) / m * (std::pow(sheared, m) - std::pow(std::max(sheared - y, 0.0), m));
}

struct Film {
  const char* name;
  double consistency, index, yield_stress, end;
  int rows;  ///< over the sheared layer
};

class Films : public testing::TestWithParam<Film> {};

// The target of 2 %, at ten particles over the sheared layer, for a Herschel-Bulkley liquid that thins at twenty. The
// flow is steady after several times H^2/nu.
TEST_P(Films, HaveTheExactProfileAndDischarge) {
  const auto [name, consistency, index, yield_stress, end, rows] = GetParam();
  const LiquidTable liquid =
      index == 1.0 ? bingham(consistency, yield_stress) : herschel_bulkley(consistency, index, yield_stress);
  const double f = density * 1.0;
  const double spacing = (1.0 - yield_stress / f) / rows;
  Flow<2> flow = make_flow<2>(layer_case(liquid, spacing, {1.0, -10.0}));
  run_to(flow, end);
  const auto exact = [&](double y) { return film_velocity(y, f, consistency, index, yield_stress); };
  const double error = profile_error(flow, exact);
  record_error(std::string("film_") + name, 2, spacing, error);
  EXPECT_LT(error, 0.02);
  double discharge = 0.0;
  double of_exact = 0.0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    discharge += flow.state.particles.velocity[i][0];
    of_exact += exact(flow.state.particles.position[i][1]);
  }
  EXPECT_NEAR(discharge / of_exact, 1.0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Rheologies, Films,
                         testing::Values(Film{"newtonian", 1000.0, 1.0, 0.0, 4.0, 10},
                                         Film{"bingham", 1000.0, 1.0, 300.0, 4.0, 10},
                                         Film{"shear_thinning", 1000.0, 0.5, 0.0, 3.0, 10},
                                         Film{"shear_thickening", 1000.0, 1.5, 0.0, 5.0, 10},
                                         Film{"herschel_bulkley", 1000.0, 0.5, 300.0, 3.0, 20}),
                         [](const auto& param) { return param.param.name; });

// Below h_y = t_y/(rho g sin) the film does not flow: it creeps at no more than the stress over the viscosity at rest.
TEST(YieldingFilm, StopsBelowItsYieldDepth) {
  const LiquidTable liquid = bingham(1000.0, 1100.0);
  CaseSpec spec = layer_case(liquid, 0.1, {1.0, -10.0});
  spec.particles.jitter = 0.0;
  Flow<2> flow = make_flow<2>(spec);
  run_to(flow, 6.0);
  const double creep = 0.5 * density * 1.0 / viscosity_at_rest(liquid);
  EXPECT_LT(largest_horizontal_speed(flow), 1.05 * creep);
}

// A plate squeezes a film of 8 times its height: the force of lubrication theory, mu V L^3/h^3. With steps as for water
// the pressure stays behind and the plate has a seventh of it.
TEST(SqueezedFilm, HasItsForceFromTheFirstTenthOfASecondOn) {
  constexpr double height = 0.05, length = 0.4, speed = 0.01, viscosity = 200.0;
  CaseSpec spec = layer_case(newtonian(viscosity), height / 10, {0.0, -0.1});
  spec.domain.periodic_x.clear();
  spec.fluid[0].min = {-0.5 * length, 0.0};
  spec.fluid[0].max = {0.5 * length, height};
  WallTable bed;
  bed.points = {{-length, 0.2}, {-length, 0.0}, {length, 0.0}, {length, 0.2}};
  bed.slip = Slip::no_slip;
  WallTable plate;
  plate.name = "plate";
  plate.shape = WallShape::box;
  plate.min = {-0.5 * length, height};
  plate.max = {0.5 * length, 2.0 * height};
  plate.fluid_side = FluidSide::outside;
  plate.slip = Slip::no_slip;
  plate.displacement = {"0", "-0.01*(t<0.1?5*t*t:t-0.05)"};
  spec.walls = {bed, plate};
  spec.probes = {force_probe({}, {"plate"})};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const Reader<2> reader(spec, flow);
  double force = 0.0;
  double of_theory = 0.0;
  while (flow.state.time < 0.3) {
    const double dt = step(flow).dt;
    if (flow.state.time < 0.2) continue;
    force += dt * reader.force(dt)[1];
    of_theory += dt * viscosity * speed * std::pow(length / (height - speed * (flow.state.time - 0.05)), 3);
  }
  EXPECT_NEAR(force / of_theory, 1.0, 0.1);
}

class Channels : public testing::TestWithParam<double> {};

// Between plates 1 m apart, ten particles from plate to axis: the parabola to 1 %, for a step of 50 and of 1000 times
// that of explicit viscous forces. From a lattice: so slow a flow would wait long for a jittered start to come to rest.
TEST_P(Channels, PoiseuilleFlowDoesNotDependOnTheStep) {
  const double over_explicit = GetParam();
  const double spacing = 0.05;
  CaseSpec spec = channel_case(newtonian(1.0), spacing, 1.0, 0.0);
  spec.particles.jitter = 0.0;
  Flow<2> as_water = make_flow<2>(spec);
  const double dt = as_water.setup.time_step_rule.largest(0.0, 0.0);
  const double nu = over_explicit * 0.125 * spacing * spacing / dt;
  fill_with(spec, newtonian(density * nu));
  Flow<2> flow = make_flow<2>(spec);
  ASSERT_TRUE(flow.setup.has_implicit_viscosity);
  EXPECT_GT(next_time_step(flow), 0.99 * dt);
  run_to(flow, std::max(60.0 * dt, 0.6 / nu));
  const double error = profile_error(flow, [&](double y) { return 0.5 / nu * y * (1.0 - y); });
  record_error(fmt::format("poiseuille_{:.0f}", over_explicit), 2, spacing, error);
  EXPECT_LT(error, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Steps, Channels, testing::Values(50.0, 1000.0));

// From rest, u = f/nu [ y (1 - y)/2 - sum of odd n 4/(n pi)^3 sin(n pi y) exp(-n^2 pi^2 nu t) ] under the acceleration
// f.
TEST(Poiseuille, StartsAsTheSeriesSays) {
  constexpr double nu = 0.5;
  CaseSpec spec = channel_case(newtonian(density * nu), 0.05, 1.0, 0.0);
  spec.scheme.courant = 0.05;  // a step is of first order in time
  Flow<2> flow = make_flow<2>(spec);
  ASSERT_TRUE(flow.setup.has_implicit_viscosity);
  run_to(flow, 0.1);
  const double t = flow.state.time;
  const double error = profile_error(flow, [&](double y) {
    double u = 0.5 * y * (1.0 - y);
    for (int n = 1; n < 40; n += 2) {
      const double k = n * std::numbers::pi;
      u -= 4.0 / std::pow(k, 3.0) * std::sin(k * y) * std::exp(-k * k * nu * t);
    }
    return u / nu;
  });
  record_error("poiseuille_started", 2, 0.05, error);
  EXPECT_LT(error, 0.01);
}

// A cylinder of radius 0.5 m that turns at 1 rad/s in a cup of radius 1.2 m, as in a rheometer: u = A (R^2/r - r). The
// wall's velocity at a particle is that of its rigid motion; with that of its own particles the error is 7 %.
TEST(TurningCylinder, DrivesTheExactFlow) {
  constexpr double inner = 0.5;
  constexpr double outer = 1.2;
  CaseSpec spec;
  spec.particles.spacing = 0.05;
  spec.physics.gravity = {0.0, 0.0};
  FluidTable gap;
  gap.shape = BlockShape::fill;
  gap.seed = {0.85, 0.0};
  gap.level = 1.3;
  spec.fluid = {gap};
  WallTable cylinder;
  cylinder.shape = WallShape::polygon;
  cylinder.points = circle(48, inner);
  cylinder.fluid_side = FluidSide::outside;
  cylinder.slip = Slip::no_slip;
  cylinder.friction = 1.0;
  cylinder.rotation = "t";
  WallTable cup = cylinder;
  cup.points = circle(48, outer);
  cup.fluid_side = FluidSide::inside;
  cup.rotation = 0.0;
  spec.walls = {cylinder, cup};
  fill_with(spec, newtonian(1000.0));
  Flow<2> flow = make_flow<2>(spec);
  run_to(flow, 1.0);
  const Particles<2>& particles = flow.state.particles;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const Vec<2>& x = particles.position[i];
    const double r = x.norm();
    const double u = inner * inner / (outer * outer - inner * inner) * (outer * outer / r - r);
    squares += (particles.velocity[i] - u / r * Vec<2>(-x[1], x[0])).squaredNorm();
    count += 1.0;
  }
  const double error = std::sqrt(squares / count) / inner;
  record_error("turning_cylinder", 2, spec.particles.spacing, error);
  EXPECT_LT(error, 0.005);
}

// From rest, u = y - sum 2 (-1)^(n+1)/(n pi) sin(n pi y) exp(-n^2 pi^2 nu t) for a plate that moves at 1 m/s. The error
// of the step falls with its length; it is first order.
TEST(Couette, StartsAsTheSeriesSays) {
  constexpr double nu = 0.5;
  constexpr double end = 0.1;
  const auto exact = [&](double y, double t) {
    double u = y;
    for (int n = 1; n < 40; ++n) {
      const double k = n * std::numbers::pi;
      u += 2.0 / k * (n % 2 == 0 ? 1.0 : -1.0) * std::sin(k * y) * std::exp(-k * k * nu * t);
    }
    return u;
  };
  std::vector<double> errors;
  for (const double courant : {0.2, 0.05}) {
    CaseSpec spec = channel_case(newtonian(density * nu), 0.05, 0.0, "t");
    spec.scheme.courant = courant;
    Flow<2> flow = make_flow<2>(spec);
    ASSERT_TRUE(flow.setup.has_implicit_viscosity);
    run_to(flow, end);
    errors.push_back(profile_error(flow, [&](double y) { return exact(y, flow.state.time); }));
  }
  record_error("couette_started", 2, 0.05, errors[1]);
  EXPECT_LT(errors[1], 0.01);
  EXPECT_LT(errors[1], errors[0]);
}

// Steady shear between plates is uniform for every law.
TEST(Couette, IsLinearForEveryLaw) {
  for (const LiquidTable& liquid :
       {bingham(100.0, 50.0), herschel_bulkley(100.0, 0.5, 50.0), herschel_bulkley(100.0, 1.5, 0.0)}) {
    Flow<2> flow = make_flow<2>(channel_case(liquid, 0.1, 0.0, "t"));
    run_to(flow, 10.0);
    EXPECT_LT(profile_error(flow, [](double y) { return y; }), 0.01) << name_of(liquid.rheology);
  }
}

// Viscous forces take the work of gravity along the bed, once the film is steady.
TEST(ThickFlow, BalancesItsEnergy) {
  Flow<2> flow = make_flow<2>(layer_case(bingham(1000.0, 300.0), 0.1, {1.0, -10.0}));
  run_to(flow, 5.0);
  Works works;
  for (int n = 0; n < 20; ++n) {
    const StepReport report = step(flow);
    works.viscous += report.work.viscous;
    works.slope += report.work.slope;
  }
  EXPECT_NEAR(-works.viscous / works.slope, 1.0, 0.02);
}

// The solve must not leave errors in motions that dissipate little: the energy norm of so thick a liquid hardly sees
// them.
TEST(ThickFlow, AVeryThickLiquidComesToRest) {
  CaseSpec spec = tank_case<2>(0.05, 2.0, 0.5);
  for (WallTable& wall : spec.walls) wall.slip = Slip::no_slip;
  fill_with(spec, newtonian(1e6));
  Flow<2> flow = make_flow<2>(spec);
  run_to(flow, 0.3);
  EXPECT_LT(largest_horizontal_speed(flow), 0.01);
}

// At the start the velocity is given and no time passes, so that viscous forces carry none of the weight.
TEST(ThickFlow, ALayerBeginsWithItsHydrostaticPressure) {
  CaseSpec spec = layer_case(newtonian(1e5), 0.1, {0.0, -10.0});
  spec.particles.jitter = 0.0;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  const Particles<2>& particles = flow.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i) || particles.position[i][1] > 0.1) continue;
    EXPECT_NEAR(particles.pressure[i] / (density * 10.0 * (1.0 - particles.position[i][1])), 1.0, 0.02) << i;
  }
}

// Water has no part of thick liquids, and a thin liquid is computed as water of its viscosity.
TEST(ThickFlow, ThinLiquidIsComputedAsWater) {
  const auto velocity_of = [](const CaseSpec& spec) {
    Flow<2> flow = make_flow<2>(spec);
    EXPECT_FALSE(has_part<ThickLiquid<2>>(flow));
    for (int n = 0; n < 5; ++n) step(flow);
    return flow.state.particles.velocity;
  };
  CaseSpec water = tank_case<2>(0.1, 1.0, 0.5);
  water.particles.jitter = 0.2;
  CaseSpec thin = water;
  fill_with(thin, newtonian(0.001));
  EXPECT_EQ(velocity_of(water), velocity_of(thin));
}

}  // namespace
}  // namespace tailwater
