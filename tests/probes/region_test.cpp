#include <gtest/gtest.h>

#include <random>

#include "probes/context.h"

namespace tailwater {
namespace {

TEST(Region, IsASegmentAndWhatIsWithinReach) {
  const Region<2> region{{0.0, 0.0}, {1.0, 0.0}};
  EXPECT_TRUE(region.contains({0.5, 0.2}, 0.2));
  EXPECT_FALSE(region.contains({0.5, 0.21}, 0.2));
  EXPECT_TRUE(region.contains({1.3, 0.4}, 0.5));  // 3-4-5 from its end
  EXPECT_FALSE(region.contains({-0.3, 0.4}, 0.49));
}

TEST(Region, APointIsASegmentWithoutLength) {
  const Region<3> region{{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}};
  EXPECT_DOUBLE_EQ(region.distance({1.0, 2.0, 5.0}), 2.0);
}

TEST(Region, ReachesWithoutBoundAlongItsDirection) {
  const Region<3> region{{0.0, 1.0, 7.0}, {2.0, 1.0, -7.0}, {0.0, 0.0, 1.0}};
  EXPECT_DOUBLE_EQ(region.distance({1.0, 1.5, 1000.0}), 0.5);
  EXPECT_DOUBLE_EQ(region.distance({3.0, 1.0, -1000.0}), 1.0);
}

TEST(Region, IsWiderByItsMargin) {
  const Region<2> region{{0.0, 0.0}, {1.0, 0.0}, Vec<2>::Zero(), 0.25};
  EXPECT_TRUE(region.contains({0.5, 0.75}, 0.5));
  EXPECT_FALSE(region.contains({0.5, 0.76}, 0.5));
}

TEST(Region, ItsBoxHoldsWhatIsWithinReach) {
  const Region<3> region{{0.0, 1.0, 7.0}, {2.0, 0.5, -7.0}, Vec<3>(0.0, 0.6, 0.8), 0.25};
  const auto box = region.box(0.5);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-4.0, 4.0);
  int inside = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec<3> x(place(random), place(random), place(random));
    if (!region.contains(x, 0.5)) continue;
    ++inside;
    EXPECT_TRUE(box.contains(x));
  }
  EXPECT_GT(inside, 1000);
  EXPECT_FALSE(box.contains(Vec<3>(2.76, 0.0, 0.0)));
  EXPECT_TRUE(box.contains(Vec<3>(2.74, 1e9, -1e9)));
}

}  // namespace
}  // namespace tailwater
