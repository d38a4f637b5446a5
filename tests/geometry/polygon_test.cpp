#include "geometry/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace tailwater {
namespace {

/// Whether a place is inside, by how often the outline goes round it: knows nothing of bands.
bool is_gone_round(const std::vector<Vec<2>>& corners, const Vec<2>& x) {
  double turn = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec<2> a = corners[k] - x;
    const Vec<2> b = corners[(k + 1) % corners.size()] - x;
    turn += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
  }
  return std::abs(turn) > std::numbers::pi;
}

// A star of many points, so that long and short edges pass every height.
TEST(Polygon, HoldsWhatItsOutlineGoesRound) {
  std::vector<Vec<2>> corners;
  for (int k = 0; k < 60; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 60;
    corners.push_back((k % 2 == 0 ? 1.0 : 0.3) * Vec<2>(std::cos(angle), std::sin(angle)));
  }
  const Polygon star(corners, 1e-9);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
  for (int n = 0; n < 5000; ++n) {
    const Vec<2> x(coordinate(random), coordinate(random));
    EXPECT_EQ(star.where(x) == Where::inside, is_gone_round(corners, x)) << x.transpose();
  }
  EXPECT_EQ(star.where({0.0, 1e300}), Where::outside);
}

TEST(Polygon, HasAnOutlineAsThickAsTheTolerance) {
  const Polygon square({{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}}, 0.01);
  for (const double beyond : {-0.009, 0.009}) {
    EXPECT_EQ(square.where({0.7, 1.0 + beyond}), Where::on_outline);
    EXPECT_EQ(square.where({0.7, beyond}), Where::on_outline);
    EXPECT_EQ(square.where({2.0 + beyond, 0.5}), Where::on_outline);
  }
  EXPECT_EQ(square.where({0.7, 0.989}), Where::inside);
  EXPECT_EQ(square.where({0.7, 1.011}), Where::outside);
  EXPECT_EQ(Polygon().where({0.0, 0.0}), Where::outside);
}

}  // namespace
}  // namespace tailwater
