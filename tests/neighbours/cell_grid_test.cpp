#include "neighbours/cell_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/dimensions.h"
#include "support/particle_set.h"

namespace tailwater {
namespace {

template <class D>
class CellGridTest : public testing::Test {};
TYPED_TEST_SUITE(CellGridTest, Dimensions);

template <int Dim>
std::vector<Vec<Dim>> random_places(std::size_t count, std::uint64_t seed) {
  Noise noise(seed);
  std::vector<Vec<Dim>> places(count);
  for (Vec<Dim>& place : places) place = noise.vector<Dim>();
  return places;
}

/// Everything within reach of any place, the particles' own and others, must be offered, and nothing twice.
template <int Dim>
void expect_complete(const CellGrid<Dim>& grid, const std::vector<Vec<Dim>>& positions,
                     const std::vector<Vec<Dim>>& places) {
  for (const Vec<Dim>& place : places) {
    std::vector<int> offered(positions.size(), 0);
    grid.for_each_near(place, [&](std::int32_t j) { ++offered[j]; });
    for (std::size_t j = 0; j < positions.size(); ++j) {
      ASSERT_LE(offered[j], 1);
      if ((positions[j] - place).norm() <= grid.reach()) {
        ASSERT_EQ(offered[j], 1) << "particle " << j << " missed";
      }
    }
  }
}

TYPED_TEST(CellGridTest, OffersEverythingWithinReachAndOrdersAll) {
  constexpr int Dim = TypeParam::value;
  const auto positions = random_places<Dim>(500, 1);
  const CellGrid<Dim> grid(positions, 0.3);
  EXPECT_NEAR(grid.reach(), 0.3, 1e-15);
  expect_complete<Dim>(grid, positions, positions);
  auto elsewhere = random_places<Dim>(200, 2);
  for (Vec<Dim>& place : elsewhere) place *= 1.5;
  expect_complete<Dim>(grid, positions, elsewhere);

  std::vector<std::int32_t> order(grid.order().begin(), grid.order().end());
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<std::int32_t>(i));
}

TYPED_TEST(CellGridTest, OffersEverythingWithinReachOfABoxInRangesThatFollowEachOther) {
  constexpr int Dim = TypeParam::value;
  const auto positions = random_places<Dim>(500, 5);
  const CellGrid<Dim> grid(positions, 0.3);
  for (const Vec<Dim>& low : random_places<Dim>(100, 6)) {
    const Vec<Dim> high = low + Vec<Dim>::NullaryExpr([](int d) { return 0.25 * d / (Dim - 1); });
    std::vector<int> offered(positions.size(), 0);
    std::int32_t last = 0;
    grid.for_each_range_near(low, high, grid.reach(), [&](std::int32_t begin, std::int32_t end) {
      EXPECT_LE(last, begin);
      last = end;
      for (std::int32_t n = begin; n < end; ++n) ++offered[grid.order()[n]];
    });
    std::size_t within_reach = 0;
    for (std::size_t j = 0; j < positions.size(); ++j) {
      const Vec<Dim> nearest = positions[j].cwiseMax(low).cwiseMin(high);
      if ((positions[j] - nearest).norm() > grid.reach()) continue;
      ++within_reach;
      EXPECT_EQ(offered[j], 1) << "particle " << j;
    }
    const auto all = std::count(offered.begin(), offered.end(), 1);
    EXPECT_LE(all, 20 + 2 * within_reach) << "many that are far";
  }
}

TYPED_TEST(CellGridTest, SurvivesAFarOutlier) {
  constexpr int Dim = TypeParam::value;
  auto positions = random_places<Dim>(300, 3);
  positions.push_back(Vec<Dim>::Constant(1e6));
  // With cells of 0.1 the grid would have 4e14 cells in 2D; that this ends at all is part of the test.
  const CellGrid<Dim> grid(positions, 0.3);
  EXPECT_GT(grid.reach(), 0.3);
  expect_complete<Dim>(grid, positions, positions);
}

TYPED_TEST(CellGridTest, FarPlacesAndEmptySetsHaveNothingNear) {
  constexpr int Dim = TypeParam::value;
  int found = 0;
  const auto count = [&](std::int32_t) { ++found; };
  const CellGrid<Dim> grid(random_places<Dim>(50, 4), 0.3);
  for (const double far : {-1e30, -10.0, 10.0, 1e30}) grid.for_each_near(Vec<Dim>::Constant(far), count);
  const CellGrid<Dim> empty(std::vector<Vec<Dim>>{}, 0.3);
  empty.for_each_near(Vec<Dim>::Zero(), count);
  CellGrid<Dim>().for_each_near(Vec<Dim>::Zero(), count);
  EXPECT_EQ(found, 0);
}

}  // namespace
}  // namespace tailwater
