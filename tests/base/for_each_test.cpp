#include "base/for_each.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace tailwater {
namespace {

TEST(ForEach, VisitsEveryIndexOnce) {
  std::vector<int> visits(5, 0);
  for_each(5, [&](std::size_t i) { ++visits[i]; });
  EXPECT_EQ(visits, std::vector<int>(5, 1));
  for_each(0, [&](std::size_t) { ADD_FAILURE() << "nothing to visit"; });
}

TEST(CountEach, AddsNumbersAndCountsWhatHolds) {
  EXPECT_EQ(count_each(4, [](std::size_t i) { return i; }), 0u + 1u + 2u + 3u);
  EXPECT_EQ(count_each(5, [](std::size_t i) { return i % 2 == 0; }), 3u);
  EXPECT_EQ(count_each(0, [](std::size_t) { return true; }), 0u);
}

TEST(SumOver, AddsInAscendingOrderFromZero) {
  // 1 + 1e16 rounds to 1e16, so the sum is 0 in this order and 1 from behind.
  constexpr std::array<double, 3> addends{1.0, 1e16, -1e16};
  EXPECT_EQ(sum_over(3, 0.0, [&](std::size_t i) { return addends[i]; }), 0.0);
  EXPECT_EQ(sum_over(3, std::string(">"), [](std::size_t i) { return std::to_string(i); }), ">012");
  EXPECT_EQ(sum_over(0, 2.5, [](std::size_t) { return 1.0; }), 2.5);
}

TEST(LargestOver, IsAtLeastWhatItStartsFrom) {
  constexpr std::array<double, 3> values{-3.0, 2.0, -7.0};
  const auto value = [&](std::size_t i) { return values[i]; };
  EXPECT_EQ(largest_over(3, -10.0, value), 2.0);
  EXPECT_EQ(largest_over(3, 5.0, value), 5.0);
  EXPECT_EQ(largest_over(1, -10.0, value), -3.0);
  EXPECT_EQ(largest_over(0, -10.0, value), -10.0);
}

TEST(IndicesWhere, AreInAscendingOrder) {
  EXPECT_EQ(indices_where(6, [](std::size_t i) { return i % 2 == 1; }), (std::vector<std::size_t>{1, 3, 5}));
  EXPECT_TRUE(indices_where(3, [](std::size_t) { return false; }).empty());
}

}  // namespace
}  // namespace tailwater
