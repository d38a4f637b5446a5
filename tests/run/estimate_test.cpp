#include "run/estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "case/formulation.h"
#include "case/reader.h"
#include "geometry/cases.h"
#include "run/inflow_estimate.h"
#include "support/pond.h"

namespace tailwater {
namespace {

using testing_cases::box_fluid, testing_cases::box_wall, testing_cases::empty_case, testing_cases::tank;

TEST(ParticleCount, FollowsFromTheShapes) {
  const ParticleCount count = expected_particle_count(tank(), make_boundary<2>(tank()));
  EXPECT_NEAR(count.fluid, 40.0, 1e-9);
  EXPECT_NEAR(count.wall, 3 * (6 + 10 + 6), 1e-9);
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z"})};
  spec.fluid = {box_fluid({0, 0, 0}, {0.4, 0.5, 0.4})};
  const ParticleCount in_3d = expected_particle_count(spec, make_boundary<3>(spec));
  EXPECT_NEAR(in_3d.fluid, 80.0, 1e-9);
  EXPECT_NEAR(in_3d.wall, 3 * (50 + 2 * 60 + 2 * 30), 1e-9);
}

void expect_one_error(const Findings& findings, const std::vector<std::string>& parts) {
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::error);
  for (const std::string& part : parts) {
    EXPECT_NE(findings[0].message().find(part), std::string::npos) << "'" << part << "' in " << findings[0].message();
  }
}

TEST(CheckMemory, ATinySpacingIsAnErrorBeforeAnythingIsMade) {
  CaseSpec spec = tank();
  EXPECT_TRUE(check_memory(spec, make_boundary<2>(spec), 1e9).empty());
  spec.particles.spacing = 1e-12;
  expect_one_error(check_memory(spec, make_boundary<2>(spec), 1e9),
                   {"particles.spacing = 1e-12 m", "1 GB are free", "at least"});
}

TEST(CheckMemory, ACaseThatIsDrawnInMillimetresIsToldSo) {
  CaseSpec spec = tank();
  spec.fluid = {box_fluid({0, 0}, {1000, 400})};
  spec.particles.spacing = 0.001;
  expect_one_error(check_memory(spec, make_boundary<2>(spec), 1e9), {"a case that is 1000 m long", "in millimetres"});
}

TEST(CheckMemory, TheSpacingItProposesFits) {
  CaseSpec spec = empty_case(1e-4);
  spec.fluid = {box_fluid({0, 0}, {1, 1})};
  // Memory for a hundredth of the 1e8 particles: ten times the spacing.
  const double available = memory_estimate<2>({.fluid = 1e6}, neighbours_in_support<2>(traits_of(spec).support));
  expect_one_error(check_memory(spec, make_boundary<2>(spec), available), {"at least 0.001 m"});
  spec.particles.spacing = 1.001e-3;
  EXPECT_TRUE(check_memory(spec, make_boundary<2>(spec), available).empty());
}

TEST(CheckMemory, ThisMachineHasMemory) { EXPECT_GT(available_memory(), 1e6); }

TEST(ReachableEnd, LimitsTheStepsOfStillWater) {
  CaseSpec spec = pond_case<2>();
  const TimeStepRule rule{.courant = 0.5, .spacing = 0.1, .reference_speed = 5.0};
  const double step = 0.5 * 0.1 / 5.0;
  spec.time.end = 0.99e9 * step;
  EXPECT_NO_THROW(require_reachable_end(spec, rule));
  for (const double end : {1.01e9 * step, 1e300}) {
    spec.time.end = end;
    EXPECT_THROW(require_reachable_end(spec, rule), InputError);
  }
}

TEST(ReachableEnd, IsUnknownWithoutGravity) {
  CaseSpec spec = pond_case<2>();
  spec.time.end = 1e300;
  EXPECT_NO_THROW(require_reachable_end(spec, {.courant = 0.5, .spacing = 0.1, .reference_speed = 0.0}));
}

TEST(EstimateRun, CountsWhatThereIs) {
  const CaseSpec spec = pond_case<2>();
  Flow<2> flow = make_flow<2>(spec);
  const RunEstimate estimate = estimate_run(spec, flow);
  EXPECT_EQ(estimate.particles.fluid, 8.0);
  EXPECT_EQ(estimate.particles.wall, 0.0);
  // Falling freely from rest, slower than sqrt(2 g L) for many steps: the rule's largest step holds.
  const double largest_step = spec.scheme.courant * 0.1 / std::sqrt(2.0 * 9.81 * 0.2);
  EXPECT_NEAR(estimate.steps, spec.time.end / largest_step, 1e-9 * estimate.steps);
  EXPECT_GT(estimate.seconds, 0.0);
}

TEST(EstimateRun, WaterIsThatOfTheCaseWhereNoLatticeFitsIt) {
  // Three rows for a depth of 0.27 m, each 0.09 m high.
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 1\n[[fluid]]\nmin = [0, 0]\nmax = [1, 0.27]\n[[wall]]\n"
      "points = [[0, 1], [0, 0], [1, 0], [1, 1]]\n",
      "case.toml");
  Flow<2> flow = make_flow<2>(spec);
  const RunEstimate estimate = estimate_run(spec, flow);
  EXPECT_EQ(estimate.particles.fluid, 30.0);
  EXPECT_NEAR(estimate.water, 0.27, 1e-12);
  EXPECT_NEAR(estimate.largest_fluid, 30.0, 1e-9);
}

TEST(EstimateRun, WaterInALayerIsThatInItsPores) {
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 1\n[[fluid]]\nmin = [0, 0]\nmax = [1, 0.3]\n[[wall]]\n"
      "points = [[0, 1], [0, 0], [1, 0], [1, 1]]\n"
      "[[porous]]\nmin = [-1, -1]\nmax = [2, 2]\nporosity = 0.4\ngrain_size = 0.02\n",
      "case.toml");
  Flow<2> flow = make_flow<2>(spec);
  const RunEstimate estimate = estimate_run(spec, flow);
  EXPECT_EQ(estimate.particles.fluid, 30.0);
  EXPECT_NEAR(estimate.water, 0.4 * 0.3, 1e-6);
  EXPECT_NEAR(estimate.largest_fluid, 30.0, 1e-9);
}

TEST(EstimateRun, TriesATankInPlaceOfALargeCase) {
  CaseSpec spec = pond_case<2>();
  Flow<2> tried = make_flow<2>(spec);
  const RunEstimate from_case = estimate_run(spec, tried);
  EXPECT_FALSE(from_case.is_from_tank);
  Flow<2> flow = make_flow<2>(spec);
  const RunEstimate estimate = estimate_run(spec, flow, 1.0);
  EXPECT_TRUE(estimate.is_from_tank);
  EXPECT_EQ(estimate.particles.fluid, 8.0);
  EXPECT_NEAR(estimate.steps, from_case.steps, 1e-9 * estimate.steps);
  EXPECT_GT(estimate.seconds, 0.0);
  EXPECT_EQ(flow.state.step, 0);
}

/// A basin 2 m wide with one open end at its left side.
WaterEstimate water_of(const std::string& open_end, double start) {
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 10\n[[wall]]\npoints = [[0, 0], [2, 0], [2, 2]]\n[[fluid]]\nmin = [0, 0]\n"
      "max = [2, 0.1]\n" +
          open_end + "from = [0, 0]\nto = [0, 2]\n",
      "case.toml");
  return estimate_water(spec, make_boundary<2>(spec), start);
}

TEST(EstimateWater, FollowsWhatComesInAndLeaves) {
  // 0.1 m^2/s for 10 s.
  const WaterEstimate filled = water_of("[[inlet]]\ndischarge = 0.1\n", 0.2);
  EXPECT_NEAR(filled.largest, 1.2, 1e-3);
  EXPECT_NEAR(filled.mean, 0.7, 1e-3);
  // Up to its level of 0.5 m, in a basin 2 m wide, and not beyond.
  const WaterEstimate level = water_of("[[inlet]]\nlevel = 0.5\n", 0.2);
  EXPECT_NEAR(level.largest, 1.0, 1e-9);
  EXPECT_GT(level.mean, 0.2);
  EXPECT_LT(level.mean, 1.0);
  // Down to it, from 0.9 m.
  const WaterEstimate drained = water_of("[[outlet]]\ndirection = [-1, 0]\nlevel = 0.5\n", 1.8);
  EXPECT_EQ(drained.largest, 1.8);
  EXPECT_GT(drained.mean, 1.0);
  EXPECT_LT(drained.mean, 1.8);
}

TEST(EstimateRun, CountsWhatComesIn) {
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 10\n[[wall]]\npoints = [[0, 0], [2, 0], [2, 2]]\n[[inlet]]\nfrom = [0, 0]\n"
      "to = [0, 2]\ndischarge = 0.1\n",
      "case.toml");
  Flow<2> flow = make_flow<2>(spec);
  const RunEstimate estimate = estimate_run(spec, flow);
  EXPECT_EQ(estimate.particles.fluid, 0.0);
  EXPECT_NEAR(estimate.largest_fluid, 100.0, 0.2);
  EXPECT_TRUE(estimate.grows_much);
  EXPECT_TRUE(estimate.is_from_tank);
}

}  // namespace
}  // namespace tailwater
