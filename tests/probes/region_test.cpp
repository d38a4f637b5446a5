#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tailwater
