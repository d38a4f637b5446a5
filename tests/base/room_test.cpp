#include "base/room.h"

#include <gtest/gtest.h>

#include <set>

namespace tailwater {
namespace {

TEST(Room, IsEnoughAndNeverMuchMore) {
  for (std::size_t count = 0; count < 100000; ++count) {
    ASSERT_GE(with_room(count), count + count / 32);
    // The reserve is 1/32 of the count; rounding up adds less than 1/8 of the sum.
    ASSERT_LE(with_room(count), 33.0 / 32.0 * 9.0 / 8.0 * static_cast<double>(count) + 1.0);
  }
}

TEST(Room, HasEightSizesBetweenPowersOfTwo) {
  std::set<std::size_t> sizes;
  for (std::size_t count = 1 << 16; count < 1 << 17; ++count) sizes.insert(with_room(count));
  EXPECT_LE(sizes.size(), 9u);  // and the first size of the next eight
}

TEST(Room, IsSetAsideOnlyWhereItIsMissing) {
  std::vector<int> array;
  make_room(array, 1000);
  EXPECT_EQ(array.capacity(), with_room(1000));
  array.resize(1000);
  const int* const place = array.data();
  make_room(array, 900);
  EXPECT_EQ(array.data(), place);
  make_room(array, 2000);
  EXPECT_TRUE(array.empty());
  EXPECT_EQ(array.capacity(), with_room(2000));
}

TEST(Room, IsNotWrittenToByAnUnwrittenArray) {
  UnwrittenArray<int> array(100, 7);
  array.resize(50);
  array.resize(100);
  EXPECT_EQ(array, UnwrittenArray<int>(100, 7));
}

}  // namespace
}  // namespace tailwater
