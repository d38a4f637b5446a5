// The two-step scheme as published: cubic spline, density source, row and dummies on the walls.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "flow/pressure_equation.h"
#include "operators/divergence.h"
#include "pressure/stages.h"
#include "schemes/cases.h"
#include "schemes/two_step.h"
#include "support/dimensions.h"
#include "support/rounding.h"

namespace tailwater {
namespace {

void make_published(SchemeTable& scheme) {
  scheme.name = SchemeName::farmani2020;
  scheme.formulation = Formulation::published;
  apply_formulation(scheme);
}

template <class D>
class TwoStepTest : public testing::Test {};
TYPED_TEST_SUITE(TwoStepTest, Dimensions);

/// A perfect lattice that moves as a whole has the full density at its predicted positions: the source is round-off.
/// One step moves a particle by at most the density error times the domain to correct it.
TYPED_TEST(TwoStepTest, LeavesAMovingLatticeAlone) {
  constexpr int Dim = TypeParam::value;
  const double dx = 0.1;
  const double length = Dim == 2 ? 2.0 : 1.0;
  CaseSpec spec;
  spec.general.dimension = Dim;
  spec.particles.spacing = dx;
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.domain.periodic_x = spec.domain.periodic_y = {0.0, length};
  if (Dim == 3) spec.domain.periodic_z = {0.0, length};
  FluidTable water;
  water.min = Coordinates(Dim, 0.0);
  water.max = Coordinates(Dim, length);
  water.velocity = VectorField(Dim, 0.7);
  spec.fluid = {water};
  make_published(spec.scheme);
  Flow<Dim> flow = make_flow<Dim>(spec);
  const double density_error = 10.0 * single_eps;
  double time_per_step = 1.0;
  for (int n = 0; n < 5; ++n) time_per_step = std::min(time_per_step, step(flow).dt);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    EXPECT_NEAR(flow.surroundings.concentration[i], 1.0, density_error);
    EXPECT_LT((flow.state.particles.velocity[i] - Vec<Dim>::Constant(0.7)).norm(),
              5.0 * density_error * length / time_per_step);
  }
}

/// Where the lattice is too dense by delta the source is rho delta/dt^2, and 0 where the density is right. Particles of
/// a uniformly compressed block have positive pressure, the highest in the middle.
TEST(TwoStep, PressesApartWhatIsTooDense) {
  CaseSpec spec = free_case(0.1);
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.0, 1.0};
  spec.fluid = {water};
  make_published(spec.scheme);
  Flow<2> flow = make_flow<2>(spec);
  for (Vec<2>& x : flow.state.particles.position) x *= 0.98;
  const StepStart<2> start = save_step_start(flow);
  WallDrive<2> drive = drive_walls(flow, start.wall_velocity, 1e-3);
  predict_pressure(flow, start, drive, 1e-3);
  double highest = 0.0;
  Vec<2> place = Vec<2>::Zero();
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (flow.surroundings.is_surface[i]) {
      EXPECT_EQ(flow.state.particles.pressure[i], 0.0);
    } else {
      EXPECT_GT(flow.state.particles.pressure[i], 0.0);
      EXPECT_GT(flow.surroundings.concentration[i], 1.0);
    }
    if (flow.state.particles.pressure[i] > highest) {
      highest = flow.state.particles.pressure[i];
      place = flow.state.particles.position[i];
    }
  }
  EXPECT_LT((place - Vec<2>::Constant(0.49)).norm(), 0.1);
}

/// Forces of a pair cancel for any pressure. The total momentum changes only by the round-off of sums over some 30
/// neighbours, whose terms are at most the momentum that moves.
TEST(TwoStep, ConservesMomentum) {
  CaseSpec spec = free_case(0.1);
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.0, 1.0};
  water.velocity = {"1 + sin(7*x*y)", "cos(5*x + y)"};
  spec.fluid = {water};
  spec.particles.jitter = 0.2;
  make_published(spec.scheme);
  Flow<2> flow = make_flow<2>(spec);
  const auto momentum = [&] {
    Vec<2> sum = Vec<2>::Zero();
    double size = 0.0;
    for (const Vec<2>& u : flow.state.particles.velocity) {
      sum += u;
      size += u.norm();
    }
    return std::pair{sum, size};
  };
  const auto [before, size_before] = momentum();
  double largest = size_before;
  constexpr int steps = 20;
  for (int n = 0; n < steps; ++n) {
    step(flow);
    largest = std::max(largest, momentum().second);
  }
  EXPECT_LT((momentum().first - before).norm(), steps * 100.0 * eps * largest);
}

/// Gravity is in the prediction, and walls are loaded by it only through the water that moves towards them. With the
/// velocity's divergence as the source, which a lattice differentiates exactly up to a factor, the first pressure of
/// the water is hydrostatic. Only the position of p = 0 is uncertain, by dx. Gravity counted twice would double the
/// pressure. (The pressure of the row itself is that of half a spacing above it: the row and the first row of water
/// share the compression between them.)
TYPED_TEST(TwoStepTest, WallRowsCarryTheWaterOnce) {
  constexpr int Dim = TypeParam::value;
  const double dx = 0.05;
  const double depth = Dim == 2 ? 0.5 : 0.3;
  CaseSpec spec = tank_case<Dim>(dx, Dim == 2 ? 1.0 : 0.4, depth);
  make_published(spec.scheme);
  Flow<Dim> flow = make_flow<Dim>(spec);
  assign_roles(flow);
  const double dt = next_time_step(flow);
  const StepStart<Dim> start = save_step_start(flow);
  locate(flow);
  WallDrive<Dim> drive = drive_walls_to_end(flow, start.wall_velocity, dt);
  const Prediction<Dim> predicted = predict(flow, start, drive, dt);
  drift(flow, start, predicted, dt);
  locate(flow);
  const std::vector<double> no_target(flow.state.particles.owned, 0.0);
  const PosedEquation equation = assemble(flow, predicted, no_target, drive, dt);
  const std::vector<Float4> velocity = as_float4<Dim>(predicted.velocity);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!has_equation(flow.role[i])) continue;
    flow.equation->rows.set_rhs(
        i, -flow.setup.liquid.density / dt *
               standard_divergence<Dim>(flow.pairs(), i, flow.surroundings.pair_vectors, velocity));
  }
  solve(flow, equation, drive);
  int tested = 0;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i) || flow.surroundings.is_surface[i]) continue;
    const double height = flow.state.particles.position[i][Dim - 1];
    EXPECT_NEAR(flow.state.particles.pressure[i], flow.setup.liquid.density * g * (depth - height),
                flow.setup.liquid.density * g * dx)
        << flow.state.particles.position[i].transpose();
    ++tested;
  }
  EXPECT_GT(tested, 0);
}

/// The published scheme on a coarse dam break until after the impact: every particle stays in the tank. The pressure
/// equation corrects the whole density error in each step, so little of the error remains.
TEST(TwoStep, RunsTheDamBreakAsPublished) {
  const double dx = 0.06;
  CaseSpec spec = zhou_case(dx, Integrator::explicit_projection);
  make_published(spec.scheme);
  Flow<2> flow = make_flow<2>(spec);
  const std::size_t count = count_fluid(flow);
  double front = 0.0;
  while (flow.state.time < 3.0 * std::sqrt(0.6 / g)) {
    const StepReport report = step(flow);
    ASSERT_EQ(report.passes, 1);
    ASSERT_LE(report.residual, PressureSolverTable{}.tolerance);
    ASSERT_EQ(count_fluid(flow), count);
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i)) continue;
      const Vec<2>& x = flow.state.particles.position[i];
      ASSERT_TRUE(x[0] > 0.0 && x[0] < 3.22 && x[1] > 0.0) << "behind a wall: " << x.transpose();
      front = std::max(front, x[0]);
    }
  }
  EXPECT_GT(front, 3.22 - 2.0 * dx);  // the next position is the wall's own row
}

}  // namespace
}  // namespace tailwater
