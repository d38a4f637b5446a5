#include "case/time_function.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tailwater {
namespace {

TEST(SmoothCurve, GoesThroughItsPointsAndKeepsTheLastOnesOutside) {
  const SmoothCurve curve({0.0, 1.0, 3.0, 3.5}, {2.0, 5.0, 4.0, 4.0});
  EXPECT_DOUBLE_EQ(curve.at(0.0), 2.0);
  EXPECT_DOUBLE_EQ(curve.at(1.0), 5.0);
  EXPECT_DOUBLE_EQ(curve.at(3.0), 4.0);
  EXPECT_DOUBLE_EQ(curve.at(-1.0), 2.0);
  EXPECT_DOUBLE_EQ(curve.at(9.0), 4.0);
}

/// Between two points it is monotone, so a discharge never leaves the range of its series.
TEST(SmoothCurve, StaysBetweenNeighbours) {
  const std::vector<double> times{0.0, 0.1, 2.0, 2.1, 2.2, 6.0};
  const std::vector<double> values{0.0, 5.0, 5.1, -3.0, -3.0, 7.0};
  const SmoothCurve curve(times, values);
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    double before = values[k];
    const double sign = values[k + 1] >= values[k] ? 1.0 : -1.0;
    for (int n = 1; n <= 50; ++n) {
      const double value = curve.at(times[k] + n / 50.0 * (times[k + 1] - times[k]));
      EXPECT_GE(sign * (value - before), -1e-12) << "after t = " << times[k];
      before = value;
    }
  }
}

/// The slope is the same on both sides of a point. The quotients differ from it by half the curvature times the step.
TEST(SmoothCurve, HasAContinuousSlope) {
  const SmoothCurve curve({0.0, 1.0, 2.0, 4.0}, {0.0, 1.0, 4.0, 5.0});
  constexpr double step = 1e-6;
  for (const double time : {1.0, 2.0}) {
    const double left = (curve.at(time) - curve.at(time - step)) / step;
    const double right = (curve.at(time + step) - curve.at(time)) / step;
    EXPECT_NEAR(left, right, 100.0 * step) << time;
    EXPECT_GT(right, 0.1);
  }
}

/// Inside, where the slopes of a straight line are known on both sides, it is that line.
TEST(SmoothCurve, FollowsAStraightLineInside) {
  const SmoothCurve curve({0.0, 0.5, 2.0, 3.0}, {1.0, 2.0, 5.0, 7.0});
  for (const double time : {0.5, 0.9, 1.3, 2.0}) EXPECT_NEAR(curve.at(time), 1.0 + 2.0 * time, 1e-12);
}

TEST(TimeFunction, IsANumberAnExpressionOrASeries) {
  EXPECT_EQ(TimeFunction().at(3.0), 0.0);
  EXPECT_EQ(TimeFunction(Varying(2.5), {}).at(3.0), 2.5);
  const TimeFunction expression(Varying("2*t + q"), {{"q", 1.0}});
  EXPECT_DOUBLE_EQ(expression.at(3.0), 7.0);
  EXPECT_EQ(expression.series(), nullptr);
  const TimeFunction series(SmoothCurve({0.0, 1.0}, {0.0, 1.0}));
  EXPECT_DOUBLE_EQ(series.at(0.5), 0.5);
  ASSERT_NE(series.series(), nullptr);
}

}  // namespace
}  // namespace tailwater
