#include "run/estimate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "run/pond.h"

namespace tailwater {
namespace {

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
  Flow<2> flow(spec);
  const RunEstimate estimate = estimate_run(spec, flow);
  EXPECT_EQ(estimate.fluid_particles, 8.0);
  EXPECT_EQ(estimate.wall_particles, 0.0);
  // Falling freely from rest, slower than sqrt(2 g L) for many steps: the rule's largest step holds.
  const double largest_step = spec.scheme.courant * 0.1 / std::sqrt(2.0 * 9.81 * 0.2);
  EXPECT_NEAR(estimate.steps, spec.time.end / largest_step, 1e-9 * estimate.steps);
  EXPECT_GT(estimate.seconds, 0.0);
}

}  // namespace
}  // namespace tailwater
