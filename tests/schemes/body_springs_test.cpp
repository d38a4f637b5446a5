// Springs, dampers and extra mass of bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bodies/floating_bodies.h"
#include "schemes/cases.h"
#include "schemes/float_boxes.h"

namespace tailwater {
namespace {

/// A box in the air beside a tank, after `time`.
BodyState<2> flown(CaseSpec spec, const std::string& freedom, double time, double& longest) {
  spec.bodies[0].free = {freedom};
  Flow<2> flow = make_flow<2>(spec);
  while (flow.state.time < time) longest = std::max(longest, step(flow).dt);
  return flow.state.motion.bodies.each[0];
}

// In the air, to first order in the step: springs swing the box, about its centre too, and extra mass slows its fall.
TEST(FloatingBody, SwingsOnItsSpringsWithItsExtraMass) {
  CaseSpec spec = tank_case<2>(0.05, 0.4, 0.2);
  add_box(spec, {2.0, 5.0}, {2.2, 5.2}, 500.0);
  BodyTable& box = spec.bodies[0];
  const double omega = 2.0 * std::numbers::pi / 0.5;
  double longest = 0.0;
  // Twice the mass: the weight stretches the spring by g/(2 omega^2), about which the box swings.
  box.extra_mass = {0.0, box.mass, 0.0};
  box.springs = {0.0, 2.0 * box.mass * omega * omega, 0.0};
  const BodyState<2> heaving = flown(spec, "y", 0.4, longest);
  const double rest = -0.5 * g / (omega * omega);
  EXPECT_NEAR(heaving.centre[1] - 5.1, rest * (1.0 - std::cos(omega * heaving.time)), -rest * omega * longest);
  box.extra_mass = {0.0, 0.0, 0.0};
  box.springs = {0.0, 0.0, box.inertia[0] * omega * omega};
  box.free = {"rotation"};
  Flow<2> flow = make_flow<2>(spec);
  flow.state.motion.bodies.each[0].velocity[2] = 0.5;
  while (flow.state.time < 0.4) longest = std::max(longest, step(flow).dt);
  const double angle = angle_of<2>(flow.state.motion.bodies.each[0].placement.linear)[0];
  EXPECT_NEAR(angle, 0.5 / omega * std::sin(omega * flow.state.time), 0.5 * longest);
}

// Linear dampers: v = v0 exp(-c t/m). Quadratic ones: 1/v = 1/v0 + q t/m, up to the
// tolerance of the coupled solve. A damper far too strong for an explicit step
// holds the box.
TEST(FloatingBody, IsSlowedByItsDampers) {
  CaseSpec spec = tank_case<2>(0.05, 0.4, 0.2);
  add_box(spec, {2.0, 5.0}, {2.2, 5.2}, 500.0);
  BodyTable& box = spec.bodies[0];
  box.velocity = {0.4, 0.0};
  double longest = 0.0;
  box.damping = {3.0 * box.mass, 0.0, 0.0};
  const BodyState<2> linear = flown(spec, "x", 0.3, longest);
  EXPECT_NEAR(linear.velocity[0] / (0.4 * std::exp(-3.0 * linear.time)), 1.0, 0.5 * 9.0 * longest * 0.3 * 1.1);
  box.damping = {};
  box.quadratic_damping = {10.0 * box.mass, 0.0, 0.0};
  const BodyState<2> quadratic = flown(spec, "x", 0.3, longest);
  EXPECT_NEAR(1.0 / quadratic.velocity[0] - 1.0 / 0.4, 10.0 * quadratic.time, 1e-4);
  box.quadratic_damping = {};
  box.damping = {0.0, 1e12, 0.0};
  EXPECT_NEAR(flown(spec, "y", 0.3, longest).velocity[1], -box.mass * g / 1e12, 1e-12);
}

// A box ten particles wide heaves on a spring under water. Potential flow does not damp it. The water takes 24 % of its
// amplitude in a period, measured on 2026-11-28, and 36 % with noise viscosity beside the hull; the bound is between.
TEST(FloatingBody, IsHardlyDampedByWaterThatMovesAroundIt) {
  CaseSpec spec = tank_case<2>(0.05, 1.6, 1.6);
  add_box(spec, {0.55, 0.55}, {1.05, 1.05}, 1000.0);
  BodyTable& box = spec.bodies[0];
  box.free = {"y"};
  const double omega = 2.0 * std::numbers::pi / 0.5;
  box.springs = {0.0, 2.0 * box.mass * omega * omega, 0.0};
  box.velocity = {0.0, 0.3};
  Flow<2> flow = make_flow<2>(spec);
  std::vector<double> turns;
  double before = 1.0;
  while (turns.size() < 5) {
    step(flow);
    const BodyState<2>& body = flow.state.motion.bodies.each[0];
    if (before * body.velocity[1] < 0.0) turns.push_back(body.centre[1]);
    before = body.velocity[1];
  }
  EXPECT_GT((turns[4] - turns[3]) / (turns[2] - turns[1]), 0.7);
}

}  // namespace
}  // namespace tailwater
