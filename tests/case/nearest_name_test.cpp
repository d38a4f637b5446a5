#include "case/nearest_name.h"

#include <gtest/gtest.h>

#include <array>

namespace tailwater {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("spacing", "spacng"), 1);
  EXPECT_EQ(edit_distance("spacing", "spaccing"), 1);
  EXPECT_EQ(edit_distance("spacing", "spazing"), 1);
  EXPECT_EQ(edit_distance("spacing", "spaicng"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("Spacing", "sPACING"), 0);
}

TEST(NearestName, IsTheOneWithFewestEdits) {
  const std::array<std::string_view, 3> valid{"max", "min", "shape"};
  EXPECT_EQ(nearest_name("shap", valid), "shape");
  EXPECT_EQ(nearest_name("Max", valid), "max");
}

TEST(NearestName, IsNoneIfAllAreFarAway) {
  const std::array<std::string_view, 3> valid{"max", "min", "x"};
  EXPECT_EQ(nearest_name("integrator", valid), std::nullopt);
  EXPECT_EQ(nearest_name("y", valid), std::nullopt);
  EXPECT_EQ(nearest_name("max", {}), std::nullopt);
}

TEST(UnknownNameHint, NamesTheNearestAndAllValidOnes) {
  const std::array<std::string_view, 2> valid{"explicit", "implicit"};
  EXPECT_EQ(unknown_name_hint("implict", valid), "did you mean \"implicit\"? valid: \"explicit\", \"implicit\"");
  EXPECT_EQ(unknown_name_hint("fast", valid), "valid: \"explicit\", \"implicit\"");
}

}  // namespace
}  // namespace tailwater
