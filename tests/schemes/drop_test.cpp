// A round drop that starts with u = (-A x, A y) in empty space. It becomes an ellipse with semi-axes a, b that follow
// an ordinary differential equation (after Monaghan 1994). With p = rho C/2 (1 - x^2/a^2 - y^2/b^2) the two momentum
// equations are A^2 - A' = C/a^2 and A^2 + A' = C/b^2.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "schemes/cases.h"
#include "support/circle.h"

namespace tailwater {
namespace {

struct Ellipse {
  double a = 1.0;  ///< semi-axis along x
  double b = 1.0;
  double A = 1.0;
};

/// a' = -A a, b' = A b, A' = A^2 (a^2 - b^2)/(a^2 + b^2), by the classical Runge-Kutta method.
Ellipse exact_ellipse(double time) {
  const auto rate = [](const Ellipse& e) {
    return Ellipse{-e.A * e.a, e.A * e.b, e.A * e.A * (e.a * e.a - e.b * e.b) / (e.a * e.a + e.b * e.b)};
  };
  const auto moved = [](const Ellipse& e, const Ellipse& r, double h) {
    return Ellipse{e.a + h * r.a, e.b + h * r.b, e.A + h * r.A};
  };
  constexpr int steps = 1000;
  const double h = time / steps;
  Ellipse e;
  for (int n = 0; n < steps; ++n) {
    const Ellipse k1 = rate(e);
    const Ellipse k2 = rate(moved(e, k1, 0.5 * h));
    const Ellipse k3 = rate(moved(e, k2, 0.5 * h));
    const Ellipse k4 = rate(moved(e, k3, h));
    e = moved(moved(moved(moved(e, k1, h / 6.0), k2, h / 3.0), k3, h / 3.0), k4, h / 6.0);
  }
  return e;
}

CaseSpec round_drop(double dx, Integrator integrator) {
  CaseSpec spec = free_case(dx);
  spec.scheme.integrator = integrator;
  FluidTable water;
  water.shape = BlockShape::polygon;
  water.points = circle(240);
  spec.fluid = {water};
  return spec;
}

/// Semi-axes from mean squares: a uniform ellipse has <x^2> = a^2/4.
Vec<2> semi_axes(const Particles<2>& particles) {
  Vec<2> squares = Vec<2>::Zero();
  for (std::size_t i = 0; i < particles.owned; ++i)
    squares += particles.position[i].cwiseProduct(particles.position[i]);
  return 2.0 * (squares / static_cast<double>(particles.owned)).cwiseSqrt();
}

Vec<2> momentum(const Particles<2>& particles) {
  Vec<2> sum = Vec<2>::Zero();
  for (std::size_t i = 0; i < particles.owned; ++i) sum += particles.velocity[i];
  return sum;
}

class StretchingDrop : public testing::TestWithParam<Integrator> {};

TEST_P(StretchingDrop, FollowsTheEllipse) {
  double previous_error = 1.0;
  for (const double dx : {0.1, 0.05}) {
    Flow<2> flow = make_flow<2>(round_drop(dx, GetParam()));
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      const Vec<2>& x = flow.state.particles.position[i];
      flow.state.particles.velocity[i] = {-x[0], x[1]};
    }
    const Vec<2> momentum_before = momentum(flow.state.particles);
    const double energy_at_start = measure(flow).kinetic_energy;
    double error = 0.0;
    double shape_error = 0.0;
    while (flow.state.time < 1.0) {
      const double dt = step(flow).dt;
      // Only the start adds energy, because its velocity belongs to t = 0 and not to half a step before. It adds dt
      // grad p = dt A u once, which is (A dt)^2 of the energy, A = 1. Then each step adds the tolerance of the pressure
      // solve.
      ASSERT_LT(measure(flow).kinetic_energy,
                energy_at_start * (1.0 + dt * dt + PressureSolverTable{}.tolerance * flow.state.step));
      const Ellipse exact = exact_ellipse(flow.state.time);
      const Vec<2> axes = semi_axes(flow.state.particles);
      error = std::max(error, (axes - Vec<2>(exact.a, exact.b)).norm());
      shape_error = std::max(shape_error, std::abs(std::log(axes[0] / axes[1] * exact.b / exact.a)));
    }
    // The surface, and hence the area, is known to one spacing only; the motion, measured by the shape, is known
    // better.
    EXPECT_LT(error, dx);
    EXPECT_LT(shape_error, previous_error);
    previous_error = shape_error;
    // Forces act in pairs: round-off of some 30 terms of size <= 3 per particle and step.
    const double round_off = 100.0 * std::numeric_limits<double>::epsilon() *
                             static_cast<double>(flow.state.particles.owned) * static_cast<double>(flow.state.step);
    EXPECT_LT((momentum(flow.state.particles) - momentum_before).norm(), round_off);
  }
}

/// Two particles 1.1 dx apart that meet head-on would be at one position after a step of 0.55 dx. The step lets them
/// approach by 0.9 dx at most. Only the speed along the line between them counts, and only towards each other.
TEST(TimeStep, LeavesParticlesThatMeetApart) {
  constexpr double dx = 0.05;
  CaseSpec spec = free_case(dx);
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {2.0 * dx, dx};
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  std::vector<Vec<2>>& velocity = flow.state.particles.velocity;
  ASSERT_EQ(flow.state.particles.owned, 2u);
  const std::size_t left = flow.state.particles.position[0][0] < flow.state.particles.position[1][0] ? 0 : 1;
  locate(flow);
  const auto step_with = [&](const Vec<2>& u_left, const Vec<2>& u_right) {
    velocity[left] = u_left;
    velocity[1 - left] = u_right;
    flow.state.last_step.approach = largest_approach(flow);
    return next_time_step(flow);
  };
  EXPECT_NEAR(step_with({1.0, 0.0}, {-1.0, 0.0}), 0.9 * dx / 2.0, 1e-6 * dx);
  EXPECT_DOUBLE_EQ(step_with({-1.0, 0.0}, {1.0, 0.0}), spec.scheme.courant * dx);
  EXPECT_DOUBLE_EQ(step_with({0.0, 1.0}, {0.0, -1.0}), spec.scheme.courant * dx);
  EXPECT_DOUBLE_EQ(step_with({1.0, 0.0}, {0.9, 0.0}), spec.scheme.courant * dx);
}

/// A column that is endless along gravity, and a drop, in a domain that is periodic in every direction.
template <int Dim>
CaseSpec falling_water(double dx, double height) {
  CaseSpec spec = free_case(dx);
  spec.general.dimension = Dim;
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.physics.gravity[Dim - 1] = -g;
  spec.domain.periodic_x = spec.domain.periodic_y = {0.0, 1.0};
  if (Dim == 3) spec.domain.periodic_z = {0.0, 1.0};
  FluidTable water;
  water.min = Coordinates(Dim, 0.0);
  water.max = Coordinates(Dim, 0.5);
  water.max[Dim - 1] = height;
  spec.fluid = {water};
  return spec;
}

/// Water with no other boundary than air has no pressure, so all of it falls with g, to the solver's tolerance.
template <int Dim>
void expect_free_fall(const CaseSpec& spec) {
  Flow<Dim> flow = make_flow<Dim>(spec);
  while (flow.state.time < 0.4) step(flow);
  Vec<Dim> fallen = Vec<Dim>::Zero();
  fallen[Dim - 1] = -g * flow.state.time;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    ASSERT_LT((flow.state.particles.velocity[i] - fallen).norm(), PressureSolverTable{}.tolerance * fallen.norm());
  }
}

TEST(FreeFall, OfWaterThatDoesNotFillADomainPeriodicInEveryDirection) {
  expect_free_fall<2>(falling_water<2>(0.05, 1.0));
  expect_free_fall<2>(falling_water<2>(0.05, 0.5));
  expect_free_fall<3>(falling_water<3>(0.1, 1.0));
  expect_free_fall<3>(falling_water<3>(0.1, 0.5));
}

TEST(FreeFall, OfWaterThatFillsADomainPeriodicInEveryDirection) {
  CaseSpec spec = periodic_square(0.05);
  spec.physics.gravity = {0.0, -g};
  expect_free_fall<2>(spec);
}

INSTANTIATE_TEST_SUITE_P(Integrators, StretchingDrop,
                         testing::Values(Integrator::explicit_projection, Integrator::implicit_projection),
                         [](const auto& test) { return std::string(name_of(test.param)); });

}  // namespace
}  // namespace tailwater
