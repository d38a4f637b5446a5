#include "closures/time_step.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tailwater {
namespace {

TEST(TimeStepRule, TakesTheStrictestLimit) {
  const TimeStepRule rule{.courant = 0.25, .spacing = 0.02, .reference_speed = 2.0};
  EXPECT_DOUBLE_EQ(rule.largest(0.0, 0.0), 0.25 * 0.02 / 2.0);  // (F41)
  EXPECT_DOUBLE_EQ(rule.largest(5.0, 0.0), 0.25 * 0.02 / 5.0);  // (F40)
  EXPECT_DOUBLE_EQ(rule.largest(0.0, 1.0), 0.125 * 0.02 * 0.02);
}

TEST(TimeStepRule, HasTheViscousLimitOfTheTwoStepScheme) {
  const TimeStepRule rule{.courant = 0.1, .spacing = 0.014, .reference_speed = 0.0, .viscous_share = 0.1};
  EXPECT_DOUBLE_EQ(rule.largest(2.0, 0.0), 0.1 * 0.014 / 2.0);  // (B20)
  EXPECT_DOUBLE_EQ(rule.largest(2.0, 1.0), 0.1 * 0.014 * 0.014);
}

TEST(TimeStepRule, HasNoLimitWhereNothingMoves) {
  const TimeStepRule rule{.courant = 0.25, .spacing = 0.02};
  EXPECT_TRUE(std::isinf(rule.largest(0.0, 0.0)));
}

}  // namespace
}  // namespace tailwater
