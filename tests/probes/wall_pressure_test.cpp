#include "probes/wall_pressure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "probes/tank.h"

namespace tailwater {
namespace {

template <class Dimension>
class WallPressureTest : public testing::Test {
 public:
  static constexpr int dimension = Dimension::value;
  using TankOf = Tank<dimension>;

  /// Every term of the sum equals the pressure at the wall up to rounding. There are some 1e2 operations on numbers of
  /// size rho g H, each with a relative error of 1.1e-16.
  static constexpr double rounding = 1e-13 * TankOf::rho * TankOf::g;

  static Row pressure(const TankOf& tank, const Coordinates& at) {
    return wall_pressure_reading<dimension>(probe_at(ProbeType::wall_pressure, at), tank.spec, tank.boundary)
        .take(tank.context())
        .at(0);
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(WallPressureTest, Dimensions);

TYPED_TEST(WallPressureTest, StillWaterIsReadExactlyAtAnyHeightUpToTheSurface) {
  using T = typename TestFixture::TankOf;
  const double level = 0.8;
  const T tank = T::filled(level);
  // Down to the corner at the floor, and up to the surface within the error of the depth (0.05 dx).
  for (const double z : {0.0, 0.01, 0.1, 0.333, 0.7, 0.79, level - 0.05 * T::dx}) {
    EXPECT_NEAR(TestFixture::pressure(tank, T::at(1.0, z))[0], T::rho * T::g * (level - z), TestFixture::rounding) << z;
  }
  for (const double z : {level + 0.05 * T::dx, 0.9, 1.4}) {
    EXPECT_EQ(TestFixture::pressure(tank, T::at(1.0, z))[0], 0.0) << z;
  }
}

/// A tank accelerated as a whole is a tank at rest in g - a, up to the weight e of rest.
TYPED_TEST(WallPressureTest, WaterThatMovesWithItsTankIsReadAsStillWater) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  const double level = 0.8, a = 5.0;
  T tank = T::filled(level);
  tank.accelerate(a);
  const WallInertia<dim> inertia{tank.blocked, tank.acceleration, {}};
  ProbeContext<dim> context = tank.context();
  context.wall_inertia = &inertia;
  for (const double z : {0.0, 0.05, 0.3, 0.5}) {
    for (const double x : {0.0, 1.0}) {
      const double read =
          wall_pressure_reading<dim>(probe_at(ProbeType::wall_pressure, T::at(x, z)), tank.spec, tank.boundary)
              .take(context)
              .at(0)[0];
      EXPECT_NEAR(read, T::rho * (T::g * (level - z) + a * (1.0 - x)), 0.003 * T::rho * a * T::dx) << x << ", " << z;
    }
  }
}

/// The air pressure is 0 at the right wall and grows away from it: the probe reads it dx in front of the wall.
TYPED_TEST(WallPressureTest, OfADryPlaceIsThatOfTheAirInFrontOfIt) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  const double level = 0.8;
  const T tank = T::filled(level);
  ProbeContext<dim> context = tank.context();
  context.air_pressure = [](const Vec<dim>& x) { return 1000.0 * (T::width - x[0]); };
  const double of_air = 1000.0 * T::dx;
  const auto read = [&](const Coordinates& at) {
    return wall_pressure_reading<dim>(probe_at(ProbeType::wall_pressure, at), tank.spec, tank.boundary)
        .take(context)
        .at(0)[0];
  };
  EXPECT_NEAR(read(T::at(T::width, 1.2)), of_air, TestFixture::rounding);
  EXPECT_NEAR(read(T::at(T::width, 0.3)), T::rho * T::g * 0.5, TestFixture::rounding);
  const ProbeTable stretch = probe_along(ProbeType::wall_pressure_mean, T::at(T::width, 1.0), T::at(T::width, 1.2));
  const Row mean = wall_pressure_mean_reading<dim>(stretch, tank.spec, tank.boundary).take(context).at(0);
  EXPECT_NEAR(mean[0], of_air, TestFixture::rounding);
  EXPECT_EQ(mean[1], 0.0);
}

TYPED_TEST(WallPressureTest, IsReadOnTheNearestPlaceOfAWall) {
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.8);
  for (const double x : {1.0 - 2.0 * T::dx, 1.0 + T::dx}) {
    EXPECT_NEAR(TestFixture::pressure(tank, T::at(x, 0.3))[0], T::rho * T::g * 0.5, TestFixture::rounding) << x;
  }
}

TYPED_TEST(WallPressureTest, ALayerOneParticleThickWetsTheWallAndASingleParticleDoesNot) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  const T jet(0.8, [](const Vec<dim>& x) { return x[0] > 1.0 - T::dx && x[dim - 1] < 0.8; });
  EXPECT_NEAR(TestFixture::pressure(jet, T::at(1.0, 0.4))[0], T::rho * T::g * 0.4, TestFixture::rounding);
  T drop = T::filled(0.0);
  Vec<dim> x = Vec<dim>::Constant(0.5);
  x[0] = 1.0 - 0.5 * T::dx;
  x[dim - 1] = 0.4;
  drop.add(x, true, 5000.0);
  drop.locate();
  EXPECT_EQ(TestFixture::pressure(drop, T::at(1.0, 0.4))[0], 0.0);
}

TYPED_TEST(WallPressureTest, HydrostaticsDoNotMakeSuctionThatNoParticleHas) {
  using T = typename TestFixture::TankOf;
  T falling = T::filled(0.8);
  std::fill(falling.particles.pressure.begin(), falling.particles.pressure.end(), 0.0);
  // At the surface all particles are below the probe. Extrapolated upwards with rho g, they would give about -rho g dx.
  const double z = 0.8 - 0.05 * T::dx;
  EXPECT_EQ(TestFixture::pressure(falling, T::at(1.0, z))[0], 0.0);
  std::fill(falling.particles.pressure.begin(), falling.particles.pressure.end(), -1.0);
  EXPECT_EQ(TestFixture::pressure(falling, T::at(1.0, z))[0], -1.0);
}

TYPED_TEST(WallPressureTest, TheMeanOverAStretchCountsDryPlacesAsZero) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  const double level = 0.6;
  const T tank = T::filled(level);
  const auto mean = [&](double low, double high) {
    return wall_pressure_mean_reading<dim>(
               probe_along(ProbeType::wall_pressure_mean, T::at(1.0, low), T::at(1.0, high)), tank.spec, tank.boundary)
        .take(tank.context())
        .at(0);
  };
  // Averaging the midpoints of equal pieces is exact for a linear pressure.
  EXPECT_NEAR(mean(0.1, 0.5)[0], T::rho * T::g * 0.3, TestFixture::rounding);
  EXPECT_EQ(mean(0.1, 0.5)[1], 1.0);
  // Half of the stretch is above water; no point (at odd multiples of dx/4) is nearer to the surface than dx/4.
  EXPECT_NEAR(mean(0.4, 0.8)[0], 0.5 * T::rho * T::g * 0.1, TestFixture::rounding);
  EXPECT_EQ(mean(0.4, 0.8)[1], 0.5);
  EXPECT_EQ(mean(0.7, 0.9), (Row{0.0, 0.0, 0.0}));
}

TYPED_TEST(WallPressureTest, TheMeanOverADiscIsThatAtItsCentreUnderWaterAndHalfDryAtTheLevel) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  const T tank = T::filled(0.6);
  const auto disc = [&](double z, double diameter) {
    ProbeTable probe = probe_at(ProbeType::wall_pressure, T::at(1.0, z));
    probe.diameter = diameter;
    return wall_pressure_reading<dim>(probe, tank.spec, tank.boundary).take(tank.context()).at(0);
  };
  // The points lie evenly around the centre, so the mean of a linear pressure is that at the centre.
  for (const double diameter : {0.2 * T::dx, 2.3 * T::dx, 6.0 * T::dx}) {
    EXPECT_NEAR(disc(0.3, diameter)[0], T::rho * T::g * 0.3, TestFixture::rounding) << diameter;
    EXPECT_EQ(disc(0.3, diameter)[1], 1.0);
  }
  // No point is nearer to the level than dx/4.
  const Row at_level = disc(0.6, 4.0 * T::dx);
  EXPECT_EQ(at_level[1], 0.5);
  EXPECT_GT(at_level[0], 0.0);
  EXPECT_LT(at_level[0], 0.5 * T::rho * T::g * 2.0 * T::dx);
}

TEST(WallPressureMean, OverARectangleIsThatOverItsDepth) {
  using T = Tank<3>;
  const T tank = T::filled(0.6);
  const auto mean = [&](const Coordinates& from, const Coordinates& to, double width) {
    ProbeTable probe = probe_along(ProbeType::wall_pressure_mean, from, to);
    probe.width = width;
    return wall_pressure_mean_reading<3>(probe, tank.spec, tank.boundary).take(tank.context()).at(0);
  };
  // From 0.5 m to 0.7 m, half of it dry: 0.1 m of water with a mean depth of 0.05 m, over twice its height.
  const Row row = mean({1.0, 0.2, 0.6}, {1.0, 0.8, 0.6}, 0.2);
  EXPECT_NEAR(row[0], 0.5 * T::rho * T::g * 0.05, 1e-9 * T::rho * T::g);
  EXPECT_EQ(row[1], 0.5);
  try {
    ProbeTable flat = probe_along(ProbeType::wall_pressure_mean, {1.0, 0.1}, {1.0, 0.2});
    flat.width = 0.1;
    const Tank<2> tank_2d = Tank<2>::filled(0.6);
    wall_pressure_mean_reading<2>(flat, tank_2d.spec, tank_2d.boundary);
    FAIL() << "a width in 2D was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a wall in 2D has no width"), std::string::npos) << error.what();
  }
}

TYPED_TEST(WallPressureTest, RefusesAPlaceFarFromWalls) {
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.6);
  try {
    TestFixture::pressure(tank, T::at(0.5, 0.5));
    FAIL() << "a place 0.5 m from every wall was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("probe 'test'"), std::string::npos) << error.what();
  }
}

}  // namespace

/// The default averages three rows of particles that arrive at sqrt(2 g H), and does not vanish with dx.
TEST(AveragingTime, IsThreeRowsOrATenthOfTheDepth) {
  const double gravity = 9.81, depth = 0.6, speed = std::sqrt(2.0 * gravity * depth);
  EXPECT_NEAR(averaging_time(0.0, 0.04, speed, gravity), 0.12 / speed, 1e-12);
  EXPECT_NEAR(averaging_time(0.0, 0.001, speed, gravity), 0.06 / speed, 1e-12);
  EXPECT_EQ(averaging_time(0.5, 0.001, speed, gravity), 0.5);
  EXPECT_EQ(averaging_time(0.0, 0.001, 0.0, 0.0), 0.0);
}

}  // namespace tailwater
