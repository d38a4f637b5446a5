// The bound on depths, 0.05 dx. On a flat surface c = 1/2 + (C - 1)/(2 (1 - S_w)), where C is the sum over a full
// lattice at that place: with |C - 1| <= 1.25 % and at most S_w = 1/2 beside a wall, c is off by at most 0.0125. Over
// the dx above a surface c falls by the sum over one row at distance dx/2, at least 0.34, and it falls fastest at the
// surface: 0.0125/0.34 = 0.037 dx. Linear interpolation over dx/4 adds (1/4)^2/8 c'' dx^2/0.34 < 0.011 dx, as
// c'' < 0.45/dx^2 (the slope of the row sum). The first test checks these numbers for all kernels.
#include "probes/water_column.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "probes/tank.h"

namespace tailwater {
namespace {

template <class Dimension>
class WaterColumnTest : public testing::Test {
 public:
  static constexpr int dimension = Dimension::value;
  using TankOf = Tank<dimension>;
  static constexpr double bound = 0.05 * TankOf::dx;

  static Row depth(const TankOf& tank, double x) {
    const auto reading =
        depth_reading<dimension>(probe_at(ProbeType::depth, TankOf::at(x, 0.7)), tank.spec, tank.boundary);
    return reading.take(tank.context()).at(0);
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(WaterColumnTest, Dimensions);

constexpr std::array all_kernels{KernelName::wendland_c2, KernelName::cubic_spline, KernelName::farzin};

TYPED_TEST(WaterColumnTest, KernelSumsAtCellFacesAreWithinTheBoundsAssumed) {
  constexpr int dim = TestFixture::dimension;
  for (const KernelName name : all_kernels) {
    const Kernel<dim> kernel = make_kernel<dim>(name, 3.0);
    // The sum over the row at distance `z` from a place that lies `offset` from the nearest particle's column.
    const auto row = [&](double z, double offset) {
      double sum = 0.0;
      for (int y = (dim == 3 ? -4 : 0); y <= (dim == 3 ? 4 : 0); ++y) {
        for (int x = -4; x <= 4; ++x) {
          const double a = x + offset;
          sum += kernel_value(kernel, std::sqrt(a * a + y * y + z * z));
        }
      }
      return sum;
    };
    for (const double offset : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5}) {
      double sum = 0.0;
      for (int z = -4; z < 4; ++z) sum += row(z + 0.5, offset);
      EXPECT_NEAR(sum, 1.0, 0.0125) << static_cast<int>(name) << ' ' << offset;
      EXPECT_GT(row(0.5, offset), 0.34) << static_cast<int>(name) << ' ' << offset;
      for (double z = 0.0; z < 3.0; z += 0.125) {
        EXPECT_LT(row(z, offset) - row(z + 0.125, offset), 0.125 * 0.45)
            << static_cast<int>(name) << ' ' << offset << ' ' << z;
      }
    }
  }
}

TYPED_TEST(WaterColumnTest, ReadsTheLevelOfATankInTheMiddleAndAtItsWall) {
  using T = typename TestFixture::TankOf;
  for (const KernelName kernel : all_kernels) {
    for (const double level : {0.25, 0.5, 1.0}) {
      const T tank = T::filled(level, kernel);
      for (const double x : {0.5, 0.52, 0.03, 0.0}) {
        const Row depth = TestFixture::depth(tank, x);
        EXPECT_NEAR(depth[0], level, TestFixture::bound) << x;
        EXPECT_NEAR(depth[1], level, TestFixture::bound) << x;
      }
    }
  }
}

TYPED_TEST(WaterColumnTest, ReadsThinLayers) {
  using T = typename TestFixture::TankOf;
  for (const int rows : {1, 2, 3}) {
    const double level = rows * T::dx;
    EXPECT_NEAR(TestFixture::depth(T::filled(level), 0.5)[0], level, TestFixture::bound);
  }
}

TYPED_TEST(WaterColumnTest, ADryBedReadsZeroEverywhere) {
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.0);
  for (const double x : {0.5, 0.02, 0.0, 1.0}) {
    EXPECT_EQ(TestFixture::depth(tank, x), (Row{0.0, 0.0, 0.0})) << x;
  }
}

TYPED_TEST(WaterColumnTest, TellsConnectedFromHighestWater) {
  using T = typename TestFixture::TankOf;
  const auto is_slab = [](double z) { return z > 0.7 && z < 1.0; };
  const T wet(0.4, [&](const Vec<TestFixture::dimension>& x) {
    const double z = x[TestFixture::dimension - 1];
    return z < 0.4 || is_slab(z);
  });
  EXPECT_NEAR(TestFixture::depth(wet, 0.5)[0], 0.4, TestFixture::bound);
  EXPECT_NEAR(TestFixture::depth(wet, 0.5)[1], 1.0, TestFixture::bound);
  EXPECT_NEAR(TestFixture::depth(wet, 0.5)[2], 0.4 + 0.3, 3 * TestFixture::bound);  // three surfaces
  const T dry(0.0, [&](const Vec<TestFixture::dimension>& x) { return is_slab(x[TestFixture::dimension - 1]); });
  EXPECT_EQ(TestFixture::depth(dry, 0.5)[0], 0.0);
  EXPECT_NEAR(TestFixture::depth(dry, 0.5)[1], 1.0, TestFixture::bound);
  EXPECT_NEAR(TestFixture::depth(dry, 0.5)[2], 0.3, 2 * TestFixture::bound);
}

TYPED_TEST(WaterColumnTest, ASingleDropIsNoWater) {
  using T = typename TestFixture::TankOf;
  T tank = T::filled(0.4);
  Vec<TestFixture::dimension> x = Vec<TestFixture::dimension>::Constant(0.5);
  x[TestFixture::dimension - 1] = 1.2;
  tank.add(x, true, 0.0);
  tank.locate();
  EXPECT_NEAR(TestFixture::depth(tank, 0.5)[1], 0.4, TestFixture::bound);
}

TYPED_TEST(WaterColumnTest, AProfileHasARowPerPlace) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  // A step in the water, far from which each side reads its own level.
  const T tank(0.6, [](const Vec<dim>& x) { return x[dim - 1] < (x[0] < 0.5 ? 0.6 : 0.3); });
  const auto reading =
      profile_reading<dim>(probe_along(ProbeType::profile, T::at(0.0, 0.0), T::at(1.0, 0.0)), tank.spec, tank.boundary);
  EXPECT_EQ(reading.columns.size(), dim + 2u);
  const std::vector<Row> rows = reading.take(tank.context());
  ASSERT_EQ(rows.size(), 20u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), dim + 2u);
    const double x = rows[k][0];
    EXPECT_NEAR(x, (k + 0.5) * T::dx, 1e-12);
    EXPECT_NEAR(rows[k][dim - 1], 0.0, 1e-12);  // bed
    if (std::abs(x - 0.5) < 3.0 * T::dx) continue;
    EXPECT_NEAR(rows[k][dim], x < 0.5 ? 0.6 : 0.3, TestFixture::bound) << x;
  }
}

TYPED_TEST(WaterColumnTest, NeedsGravityAndABed) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  T tank = T::filled(0.4);
  const auto message = [&](const Coordinates& at) -> std::string {
    try {
      depth_reading<dim>(probe_at(ProbeType::depth, at), tank.spec, tank.boundary);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message(T::at(0.5, 9.0)), "no error");
  EXPECT_NE(message(T::at(1.2, 0.0)).find("probe 'test'"), std::string::npos);
  EXPECT_NE(message({0.5}).find("probe 'test'"), std::string::npos);
  tank.spec.physics.gravity.assign(dim, 0.0);
  EXPECT_NE(message(T::at(0.5, 0.0)).find("gravity"), std::string::npos);
}

// A tank that has turned and moved, with all that is in it, and a gauge that is fastened to it.
TYPED_TEST(WaterColumnTest, InATankThatMovesReadsAsInTheTank) {
  constexpr int dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  T tank = T::filled(0.5);
  WallTable& walls = tank.spec.walls[0];
  walls.rotation = "0.3*t";
  walls.displacement.assign(dim, 0.0);
  walls.displacement[0] = "2*t";
  if (dim == 3) walls.axis = {0.0, 1.0, 0.0};
  tank.boundary = make_boundary<dim>(tank.spec);
  const auto reading = depth_reading<dim>(probe_at(ProbeType::depth, T::at(0.3, 0.7)), tank.spec, tank.boundary);
  const auto profile =
      profile_reading<dim>(probe_along(ProbeType::profile, T::at(0.1, 0.0), T::at(0.9, 0.0)), tank.spec, tank.boundary);
  const Row before = reading.take(tank.context()).at(0);
  const std::vector<Row> rows_before = profile.take(tank.context());
  const AffineMap<dim> map = WallPath<dim>(tank.spec, walls, CaseLabel("wall", "tank")).at(1.0);
  for (Vec<dim>& x : tank.particles.position) x = map(x);
  for (WallFace<dim>& face : tank.boundary.faces) face = moved(map, face);
  tank.locate();
  const Row after = reading.take(tank.context(1.0)).at(0);
  for (int column = 0; column < 3; ++column) EXPECT_NEAR(after[column], before[column], 1e-9) << column;
  EXPECT_NEAR(after[0], 0.5, TestFixture::bound);
  EXPECT_LT(reading.region(1.0).distance(map(Vec<dim>::Map(T::at(0.3, 0.4).data()))), 1e-12);
  const std::vector<Row> rows_after = profile.take(tank.context(1.0));
  ASSERT_EQ(rows_after.size(), rows_before.size());
  for (std::size_t k = 0; k < rows_after.size(); ++k) {
    for (std::size_t c = 0; c < rows_after[k].size(); ++c) EXPECT_NEAR(rows_after[k][c], rows_before[k][c], 1e-9);
  }
}

TEST(WaterColumn, FindsTheHumpThatCoversTheFloorAndTheWaterUnderADeck) {
  using T = Tank<2>;
  T tank = T::filled(0.8);
  // A floating face at 0.3 that looks up covers the floor below it, like the top of a hump laid over the tank's floor.
  tank.boundary.faces.push_back({{Vec<2>(0.2, 0.3), Vec<2>(0.4, 0.3)}, Vec<2>(0.0, 1.0), 0});
  // A dry deck above the water is no bed of it.
  tank.boundary.faces.push_back({{Vec<2>(0.6, 1.2), Vec<2>(0.8, 1.2)}, Vec<2>(0.0, 1.0), 0});
  const auto column = [&](double x) {
    ProbeTable probe = probe_along(ProbeType::profile, {x, 0.0}, {x, 0.0});
    return profile_reading<2>(probe, tank.spec, tank.boundary).take(tank.context()).at(0);
  };
  EXPECT_NEAR(column(0.3)[1], 0.3, 1e-12);
  EXPECT_NEAR(column(0.3)[2], 0.5, 0.05 * T::dx);
  EXPECT_NEAR(column(0.7)[1], 0.0, 1e-12);
  EXPECT_NEAR(column(0.7)[2], 0.8, 0.05 * T::dx);
}

TEST(WaterColumn, ConnectsALiquidWithTheBedThroughAnotherOne) {
  using T = Tank<2>;
  T tank(0.8, [](const Vec<2>& x) { return x[1] < 0.8 && (x[1] < 0.5 || x[0] < 0.5 || x[1] > 0.6); });
  ParticleLiquids liquids{.end = {100, 200}, .of_block = {0, 1}, .density = {2.0, 1.0}, .is_thin = {1, 1}};
  for (std::size_t i = 0; i < tank.particles.size(); ++i) {
    tank.particles.id[i] = tank.particles.position[i][1] < 0.3 ? 0 : 100;
  }
  ProbeContext<2> context = tank.context();
  context.liquids = &liquids;
  const auto depth_at = [&](double x, int liquid) {
    context.liquid = liquid;
    return depth_reading<2>(probe_at(ProbeType::depth, {x, 0.0}), tank.spec, tank.boundary).take(context).at(0);
  };
  constexpr double bound = 0.05 * T::dx;
  EXPECT_NEAR(depth_at(0.25, 0)[0], 0.3, bound);
  EXPECT_NEAR(depth_at(0.25, 1)[0], 0.8, bound);
  EXPECT_NEAR(depth_at(0.75, 1)[0], 0.5, bound);  // below a gap
  EXPECT_NEAR(depth_at(0.75, 1)[1], 0.8, bound);
}

TEST(WaterColumn, EndsAtACeiling) {
  using T = Tank<2>;
  T tank = T::filled(0.8);
  tank.boundary.faces.push_back({{Vec<2>(0.4, 0.5), Vec<2>(0.6, 0.5)}, Vec<2>(0.0, -1.0), 0});
  const auto reading = depth_reading<2>(probe_at(ProbeType::depth, {0.5, 0.0}), tank.spec, tank.boundary);
  const Row depth = reading.take(tank.context()).at(0);
  EXPECT_NEAR(depth[0], 0.5, 1e-12);
  EXPECT_NEAR(depth[1], 0.5, 1e-12);
  EXPECT_NEAR(depth[2], 0.5, 1e-12);
}

}  // namespace
}  // namespace tailwater
