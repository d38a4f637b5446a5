// The energy balance: the work of walls and viscosity, and the rest, which limits the density source.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "schemes/cases.h"

namespace tailwater {
namespace {

double energy(const Flow<2>& flow) { return measure(flow).energy(); }

/// Sums of the energy balance over several steps.
struct Books {
  double wall_work = 0.0;
  double viscous_work = 0.0;
  double slope_work = 0.0;
  double mean_share = 0.0;
};

Books run_to(Flow<2>& flow, double end) {
  Books books;
  int steps = 0;
  for (; flow.state.time < end; ++steps) {
    const StepReport report = step(flow);
    books.wall_work += report.work.walls;
    books.viscous_work += report.work.viscous;
    books.slope_work += report.work.slope;
    books.mean_share += report.density_share;
  }
  books.mean_share /= steps;
  return books;
}

/// Largest rise of the energy, over its initial value, in a dam break to T = t sqrt(g/H).
double rise_of_dam_break(const CaseSpec& spec, double T) {
  Flow<2> flow = make_flow<2>(spec);
  const double start = energy(flow);
  double least = start;
  double rise = 0.0;
  while (flow.state.time < T * std::sqrt(0.6 / g)) {
    step(flow);
    least = std::min(least, energy(flow));
    rise = std::max(rise, energy(flow) - least);
  }
  return rise / start;
}

/// Makes the water 2 % too light, and deeper.
void stretch_up(Flow<2>& flow) {
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.state.particles.is_fluid(i)) flow.state.particles.position[i][1] *= 1.02;
  }
}

class Energy : public testing::TestWithParam<Integrator> {};

/// Walls lift the water and let it down. Velocity, works and potential energy count at the same instant of a step.
TEST_P(Energy, OfATankThatMovesUpAndDownIsTheWorkOfItsWalls) {
  constexpr double depth = 0.4;
  CaseSpec spec = tank_case<2>(0.05, 0.8, depth);
  spec.scheme.integrator = GetParam();
  spec.walls[0].displacement = {"0", "0.05*(1 - cos(2*pi*t))"};
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  double least = energy(flow);
  double rise = 0.0;
  double work = 0.0;
  while (flow.state.time < 1.2) {
    const StepReport report = step(flow);
    work += report.work.walls;
    const double left = energy(flow) + report.fallen - work;
    least = std::min(least, left);
    rise = std::max(rise, left - least);
  }
  EXPECT_LT(rise, 0.003 * energy_scale(flow));  // 0.015 with the energy of the end of explicit steps
}

TEST(DensitySource, SpendsNoMoreEnergyThanWasDissipated) {
  CaseSpec spec = zhou_case(0.012, Integrator::explicit_projection);
  spec.particles.jitter = 0.15;  // particles are too close by their kernel sums
  spec.scheme.pair_vectors = PairVectors::kernel;
  spec.scheme.courant = 0.25;
  // The default slack is 1e-4 of m g L/2 plus the kinetic energy, and m g L/2 is the initial energy.
  EXPECT_LT(rise_of_dam_break(spec, 0.25), 1e-4);
  // Without a limit, the kernel's own pair vectors cause a rise of 1.9e-4 (observed, not derived). The limit is
  // therefore active in this test. With corrected pair vectors the rise would be 3e-6.
  spec.study.energy_slack = 1e3;
  EXPECT_GT(rise_of_dam_break(spec, 0.25), 1.5e-4);
}

TEST(DensitySource, PullsTogetherWhateverTheEnergy) {
  CaseSpec spec = tank_case<2>(0.05, 0.5, 0.5);
  Flow<2> flow = make_flow<2>(spec);
  stretch_up(flow);
  step(flow);
  const double start = measure(flow).density_error_mean;
  ASSERT_LT(start, -0.01);
  while (flow.state.time < 1.6) {
    flow.state.last_step.energy_rise = 1e9;  // J/m
    ASSERT_EQ(step(flow).density_share, 0.0);
  }
  // While water at sqrt(2 g L) moves by dx, the density source removes 1.5 density_relaxation = 0.075 of the density
  // deficit. 1.6 s are 100 such times, after which e^-7.5 = 0.0006 would remain. The bound is larger, since the
  // outermost rows sustain no tension.
  EXPECT_GT(measure(flow).density_error_mean, 0.2 * start);
}

/// The correction per step is proportional to the step, so steps of half the length correct as much in the same time.
TEST(DensitySource, CorrectsAsFastWhateverTheStep) {
  std::array<double, 2> left{};
  for (std::size_t n = 0; n < left.size(); ++n) {
    CaseSpec spec = tank_case<2>(0.05, 0.5, 0.5);
    spec.scheme.courant /= static_cast<double>(n + 1);
    spec.study.shifting = 0.0;
    Flow<2> flow = make_flow<2>(spec);
    stretch_up(flow);
    locate(flow);
    const double start = measure(flow).density_error_mean;
    ASSERT_LT(start, -0.01);
    while (flow.state.time < 0.12) step(flow);
    left[n] = measure(flow).density_error_mean / start;
  }
  EXPECT_NEAR(left[0], left[1], 0.1);  // with a correction independent of the step 0.36, not 0.60
}

TEST(DensitySource, GivesNoEnergyToAStartThatHitsItsWalls) {
  constexpr double dx = 0.012;
  CaseSpec spec = zhou_case(dx, Integrator::implicit_projection);
  apply_formulation(spec.scheme);
  for (double& corner : spec.fluid[0].min) corner += 0.5 * dx;  // away from the walls, which the water hits later
  for (double& corner : spec.fluid[0].max) corner += 0.5 * dx;
  // The error of the second projection, and the energy that it adds, depend on the solver.
  for (const PreconditionerName preconditioner : {PreconditionerName::ssor, PreconditionerName::cell_multigrid}) {
    spec.pressure_solver.preconditioner = preconditioner;
    EXPECT_LT(rise_of_dam_break(spec, 0.15), 1e-4) << name_of(preconditioner);  // the energy_slack, as above
  }
}

TEST_P(Energy, IsKeptByWaterThatLeavesAWall) {
  CaseSpec spec = free_case(0.02);
  spec.scheme.integrator = GetParam();
  apply_formulation(spec.scheme);
  spec.physics.gravity = {0.0, -g};
  WallTable corner;
  corner.points = {{0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}};
  spec.walls = {corner};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {0.4, 0.4};
  water.velocity = {2.0, 0.0};  // away from the wall, which sustains no tension
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  const double start = energy(flow);
  while (flow.state.time < 0.06) {
    step(flow);
    ASSERT_LT(energy(flow), start);
  }
  // Observed, not derived: 0.978 (explicit). It was 0.89 with walls that sustain tension in the equation but not in the
  // force.
  EXPECT_GT(energy(flow), 0.96 * start);
}

TEST_P(Energy, OfAPistonIsItsWork) {
  CaseSpec spec;
  spec.scheme.integrator = GetParam();
  spec.particles.spacing = 0.025;
  WallTable tank;
  tank.points = {{-0.3, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  WallTable piston;
  piston.points = {{0.0, 1.0}, {0.0, 0.0}};
  piston.displacement = {"0.1*(1 - cos(pi*t/2))", 0.0};
  spec.walls = {tank, piston};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.0, 0.3};
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  step(flow);  // the lattice settles
  const double start = energy(flow);
  const Books books = run_to(flow, 1.0);
  // The sum over the kernel misses (dx/depth)^2 of the force, 4 % here; the dissipation is far smaller.
  EXPECT_GT(energy(flow) - start, 20.0);  // J/m; rho g H^2/2 times half the way is 44
  // 4 %, and 2 % for the dissipation, which is observed and not derived.
  EXPECT_NEAR(books.wall_work, energy(flow) - start, 0.06 * books.wall_work);
  EXPECT_GT(books.mean_share, 0.95);  // the density source is hardly limited
}

/// Water over a bed with a period of 0.6 m.
CaseSpec water_over_a_period(double depth) {
  CaseSpec spec = free_case(0.05);
  spec.domain.periodic_x = {0.0, 0.6};
  WallTable bed;
  bed.points = {{0.0, 0.0}, {0.6, 0.0}};
  spec.walls = {bed};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {0.6, depth};
  spec.fluid = {water};
  return spec;
}

TEST_P(Energy, OfWaterDraggedAlongIsTheWorkOfViscosity) {
  CaseSpec spec = water_over_a_period(0.5);
  spec.scheme.integrator = GetParam();
  spec.physics.viscosity = 0.25;
  spec.physics.gravity = {0.0, -g};
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].displacement = {"t", 0.0};
  Flow<2> flow = make_flow<2>(spec);
  const double start = energy(flow);
  const Books books = run_to(flow, 0.1);
  EXPECT_GT(books.viscous_work, 1.0);  // J/m
  // Observed, not derived: the effect of the settling lattice is below 1 % of the work (1.05 % with twice the
  // correction of too light water).
  EXPECT_NEAR(books.viscous_work, energy(flow) - start, 0.01 * books.viscous_work);
  EXPECT_GT(books.mean_share, 0.95);
}

// At the end, at 2 m/s, the water has crossed the seam of the period of 0.6 m more than once.
TEST_P(Energy, OfWaterThatFallsAlongAPeriodIsTheWorkOfTheSlope) {
  CaseSpec spec = water_over_a_period(0.3);
  spec.scheme.integrator = GetParam();
  spec.physics.gravity = {2.0, -g};
  Flow<2> flow = make_flow<2>(spec);
  const double start = energy(flow);
  const Books books = run_to(flow, 1.0);
  const double speed = 2.0 * flow.state.time;
  const double fallen = 0.5 * 0.6 * 0.3 * 1000.0 * speed * speed;  // J/m
  EXPECT_NEAR(books.slope_work, fallen, 0.01 * fallen);
  EXPECT_NEAR(energy(flow) - start, books.slope_work, 0.01 * fallen);
}

TEST_P(Energy, ARiseFadesAndHoldsTheDensitySourceMeanwhile) {
  CaseSpec spec = tank_case<2>(0.05, 0.5, 0.5);
  spec.scheme.integrator = GetParam();
  spec.study.energy_slack = 1.0;  // the effect of the settling lattice is small
  Flow<2> flow = make_flow<2>(spec);
  const double mass = flow.setup.liquid.density * 0.5 * 0.5;
  flow.state.last_step.energy_rise = 0.8 * mass * g * flow.setup.length / 2.0;
  while (flow.state.time < 0.3) {
    const double density_share = step(flow).density_share;
    const double rise = 0.8 * std::exp(-1.4 * flow.state.time * std::sqrt(2.0 * g / flow.setup.length));
    ASSERT_NEAR(density_share, (1.0 - rise) * (1.0 - rise), 0.01);
  }
}

INSTANTIATE_TEST_SUITE_P(Integrators, Energy,
                         testing::Values(Integrator::explicit_projection, Integrator::implicit_projection),
                         [](const auto& test) {
                           return test.param == Integrator::explicit_projection ? "explicit_projection"
                                                                                : "implicit_projection";
                         });

}  // namespace
}  // namespace tailwater
