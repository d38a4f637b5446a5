#include "probes/run_up.h"

#include <gtest/gtest.h>

#include <cmath>

#include "probes/tank.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class Dimension>
class RunUpTest : public testing::Test {
 public:
  static constexpr int dimension = Dimension::value;
  using TankOf = Tank<dimension>;

  static Row read(const TankOf& tank, const ProbeTable& probe = probe_at(ProbeType::run_up, {})) {
    return run_up_reading<dimension>(probe, tank.spec, tank.boundary).take(tank.context()).at(0);
  }

  /// Water up to 0.6 m, and between these heights within 0.3 m of the left wall.
  static TankOf with_tongue(double low, double high) {
    return TankOf(0.6, [=](const Vec<dimension>& x) {
      return x[dimension - 1] < 0.6 || (x[0] < 0.3 && x[dimension - 1] > low && x[dimension - 1] < high);
    });
  }
};
TYPED_TEST_SUITE(RunUpTest, Dimensions);

/// The highest row stands half a spacing below the level and beside upright walls, so nothing is left of the spacing.
TYPED_TEST(RunUpTest, OnAnUprightWallIsTheLevel) {
  using T = typename TestFixture::TankOf;
  const Row row = TestFixture::read(T::filled(0.6));
  EXPECT_NEAR(row[0], 0.6, 1e-12);
  EXPECT_NEAR(row[1], 0.6, 1e-12);
}

TYPED_TEST(RunUpTest, TellsConnectedFromHighestWater) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const Row tongue = TestFixture::read(TestFixture::with_tongue(0.5, 1.1));
  EXPECT_NEAR(tongue[0], 1.1, 1e-12);
  // A gap of 0.25 m = 5 dx.
  const Row splash = TestFixture::read(TestFixture::with_tongue(0.85, 1.1));
  EXPECT_NEAR(splash[0], 0.6, 1e-12);
  EXPECT_NEAR(splash[1], 1.1, 1e-12);
  T drop = T::filled(0.6);
  Vec<Dim> x = Vec<Dim>::Constant(0.5 * T::dx);
  x[Dim - 1] = 0.6 + 0.5 * T::dx;
  drop.add(x, true, 0.0);
  x[Dim - 1] = 1.2;
  drop.add(x, true, 0.0);
  drop.locate();
  const Row drops = TestFixture::read(drop);
  EXPECT_NEAR(drops[0], 0.6 + T::dx, 1e-12);  // the first drop stands where the next row would
  EXPECT_NEAR(drops[1], 1.2 + 0.5 * T::dx, 1e-12);
}

TYPED_TEST(RunUpTest, CountsOnlyTheWallsInItsRegion) {
  constexpr int Dim = TestFixture::dimension;
  ProbeTable right = probe_at(ProbeType::run_up, {});
  right.region_min.assign(Dim, -1.0);
  right.region_min[0] = 0.5;
  right.region_max.assign(Dim, 2.0);
  EXPECT_NEAR(TestFixture::read(TestFixture::with_tongue(0.5, 1.1), right)[0], 0.6, 1e-12);
}

TYPED_TEST(RunUpTest, OfADryWallIsItsLowestPoint) {
  using T = typename TestFixture::TankOf;
  EXPECT_EQ(TestFixture::read(T::filled(0.0)), (Row{0.0, 0.0}));
}

TYPED_TEST(RunUpTest, RemembersTheLargest) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.6);
  const auto probe = probe_at(ProbeType::run_up, {});
  const Reading<Dim> reading = run_up_reading<Dim>(probe, tank.spec, tank.boundary);
  reading.take(tank.context(0.0));
  reading.take(T::filled(0.8).context(1.0));
  const Reading<Dim> resumed = run_up_reading<Dim>(probe, tank.spec, tank.boundary);
  *resumed.memory = *reading.memory;
  resumed.take(T::filled(0.4).context(2.0));
  const std::vector<double> totals = resumed.totals();
  ASSERT_EQ(totals.size(), totals_of(ProbeType::run_up, Dim).size());
  EXPECT_NEAR(totals[0], 0.8, 1e-12);
  EXPECT_EQ(totals[1], 1.0);
  EXPECT_NEAR(totals[2], 0.8, 1e-12);
}

/// On a beach of 45 degrees. Of the highest row, half a spacing below the level, the particle next to the beach is less
/// than or just dx/sqrt(2) from it, so its foot is at most dx/2 lower; its half spacing up the beach is sqrt(2)/4 dx.
TEST(RunUp, OnABeachIsTheLevelUpToASpacing) {
  using T = Tank<2>;
  for (const double toe : {0.3, 0.31, 0.32, 0.33, 0.34}) {
    T tank(0.4, [&](const Vec<2>& x) { return x[1] < 0.4 && x[1] > x[0] - toe; });
    tank.spec.walls[0].shape = WallShape::polyline;
    tank.spec.walls[0].fluid_side = FluidSide::left;
    tank.spec.walls[0].points = {{0.0, 1.5}, {0.0, 0.0}, {toe, 0.0}, {1.0, 1.0 - toe}};
    tank.boundary = make_boundary<2>(tank.spec);
    ProbeTable beach = probe_at(ProbeType::run_up, {});
    beach.region_min = {0.2, 0.0};
    beach.region_max = {2.0, 2.0};
    const Row row = run_up_reading<2>(beach, tank.spec, tank.boundary).take(tank.context()).at(0);
    EXPECT_LT(row[0], 0.4 + (std::sqrt(2.0) / 4.0 - 0.5) * T::dx) << toe;
    EXPECT_GT(row[0], 0.4 + (std::sqrt(2.0) / 4.0 - 1.0 - 1e-9) * T::dx) << toe;
  }
}

}  // namespace
}  // namespace tailwater
