// Which walls are near the water: all that it can reach, few others, and those that it has left no more.
#include "walls/near_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "support/dimensions.h"
#include "support/particle_set.h"

namespace tailwater {
namespace near_walls_test {

constexpr double dx = 0.1;
constexpr double reach = 4.0 * dx;

template <class D>
class NearWallsTest : public testing::Test {};
TYPED_TEST_SUITE(NearWallsTest, Dimensions);

/// One particle on a wall that moves, then a row of wall particles along x, from -5 to 5 m.
template <int Dim>
Walls<Dim> long_wall() {
  Walls<Dim> walls;
  walls.boundary.walls = {{.name = "bed"}, {.name = "gate", .body = 1}};
  walls.particles.position.push_back(Vec<Dim>::Constant(7.0));
  for (int n = -50; n <= 50; ++n) walls.particles.position.push_back(n * dx * Vec<Dim>::UnitX());
  walls.particles.wall.assign(102, 0);
  walls.particles.wall[0] = 1;
  walls.moving = 1;
  walls.kept = 102;
  walls.all = 102;
  return walls;
}

/// One particle of water at x, a little above the wall.
template <int Dim>
Particles<Dim> water_at(double x) {
  Vec<Dim> place = Vec<Dim>::Constant(0.5 * dx);
  place[0] = x;
  return fluid_at<Dim>(std::vector<Vec<Dim>>{place}, dx);
}

template <int Dim>
void expect_all_in_reach_are_near(const NearWalls<Dim>& near, const Walls<Dim>& walls, const Particles<Dim>& water) {
  int far = 0;
  for (std::size_t row = 1; row < 102; ++row) {
    const double distance = (walls.particles.position[row] - water.position[0]).norm();
    const bool is_near = near.is_near(walls, static_cast<std::int32_t>(row));
    if (distance < reach) {
      EXPECT_TRUE(is_near) << row;
    }
    // The cell of the water and the ones beside it end at most two edges away.
    if (distance > 2.5 * reach) {
      EXPECT_FALSE(is_near) << row;
    }
    far += is_near ? 0 : 1;
  }
  EXPECT_GT(far, 80);
}

TYPED_TEST(NearWallsTest, AreThoseInReach) {
  constexpr int Dim = TypeParam::value;
  const Walls<Dim> walls = long_wall<Dim>();
  NearWalls<Dim> near({}, walls, {}, reach);
  EXPECT_FALSE(near.is_near(walls, 51));
  EXPECT_TRUE(near.is_near(walls, 0));  // it moves
  for (double x = -6.0; x < 6.0; x += 0.07) {
    const Particles<Dim> water = water_at<Dim>(x);
    near.update(walls, water, FarWalls::dropped);
    expect_all_in_reach_are_near(near, walls, water);
    EXPECT_FALSE(near.misses_some(water));
  }
}

TYPED_TEST(NearWallsTest, ArriveOnceAndStayUntilTheFarOnesAreDropped) {
  constexpr int Dim = TypeParam::value;
  const Walls<Dim> walls = long_wall<Dim>();
  NearWalls<Dim> near({}, walls, {}, reach);
  const std::vector<std::int32_t> first = near.update(walls, water_at<Dim>(-3.0), FarWalls::dropped);
  EXPECT_FALSE(first.empty());
  const Particles<Dim> gone = water_at<Dim>(2.0);
  EXPECT_TRUE(near.misses_some(gone));
  const std::vector<std::int32_t> second = near.update(walls, gone, FarWalls::kept);
  EXPECT_FALSE(near.misses_some(gone));
  const std::set<std::int32_t> rows(first.begin(), first.end());
  EXPECT_TRUE(std::ranges::none_of(second, [&](std::int32_t row) { return rows.contains(row); }));
  EXPECT_TRUE(std::ranges::all_of(first, [&](std::int32_t row) { return near.is_near(walls, row); }));
  EXPECT_TRUE(near.update(walls, gone, FarWalls::dropped).empty());
  EXPECT_TRUE(std::ranges::none_of(first, [&](std::int32_t row) { return near.is_near(walls, row); }));
  EXPECT_TRUE(std::ranges::all_of(second, [&](std::int32_t row) { return near.is_near(walls, row); }));
}

TYPED_TEST(NearWallsTest, AreSeenAcrossAPeriodicEdge) {
  constexpr int Dim = TypeParam::value;
  const Walls<Dim> walls = long_wall<Dim>();
  PeriodicDomain<Dim> domain;
  domain[0] = std::pair{-5.0, 5.0};
  NearWalls<Dim> near({}, walls, domain, reach);
  EXPECT_TRUE(near.misses_some(water_at<Dim>(4.95)));
  near.update(walls, water_at<Dim>(4.95), FarWalls::dropped);
  EXPECT_TRUE(near.is_near(walls, 1));
  EXPECT_TRUE(near.is_near(walls, 101));
  EXPECT_FALSE(near.is_near(walls, 51));
}

TYPED_TEST(NearWallsTest, AreRestoredFromTheParticles) {
  constexpr int Dim = TypeParam::value;
  const Walls<Dim> walls = long_wall<Dim>();
  NearWalls<Dim> near({}, walls, {}, reach);
  const Particles<Dim> water = water_at<Dim>(1.0);
  std::vector<Vec<Dim>> points{water.position[0]};
  const std::vector<std::int32_t> rows = near.update(walls, water, FarWalls::dropped);
  for (const std::int32_t row : rows) points.push_back(walls.particles.position[row]);
  Particles<Dim> all = fluid_at<Dim>(points, dx);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    all.kind[n + 1] = ParticleKind::wall;
    all.wall_row[n + 1] = rows[n];
  }
  NearWalls<Dim> restored({}, walls, {}, reach);
  restored.restore(walls, all);
  for (std::int32_t row = 0; row < 102; ++row) EXPECT_EQ(restored.is_near(walls, row), near.is_near(walls, row)) << row;
  EXPECT_EQ(restored.misses_some(all), near.misses_some(all));
  EXPECT_TRUE(restored.update(walls, all, FarWalls::dropped).empty());
}

}  // namespace near_walls_test
}  // namespace tailwater
