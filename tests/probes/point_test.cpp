#include "probes/point.h"

#include <gtest/gtest.h>

#include "probes/tank.h"
#include "support/liquids.h"

namespace tailwater {
namespace {

template <class Dimension>
class PointTest : public testing::Test {
 public:
  static constexpr int dimension = Dimension::value;
  using TankOf = Tank<dimension>;

  static Row pressure(const TankOf& tank, const Coordinates& at) {
    return pressure_reading<dimension>(probe_at(ProbeType::pressure, at)).take(tank.context()).at(0);
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PointTest, Dimensions);

TYPED_TEST(PointTest, LinearPressureIsReadExactlyInsideAtWallsAndNearTheSurface) {
  using T = typename TestFixture::TankOf;
  const double level = 0.8;
  const T tank = T::filled(level);
  for (const double x : {0.5, 0.51, 0.02, 0.0}) {
    for (const double z : {0.0, 0.02, 0.4, 0.77, 0.79}) {
      const Row row = TestFixture::pressure(tank, T::at(x, z));
      // Rounding (1e2 operations) times the condition number of the fit, at most 1e3.
      EXPECT_NEAR(row[0], T::rho * T::g * (level - z), 1e2 * 1.1e-16 * 1e3 * T::rho * T::g) << x << ' ' << z;
      EXPECT_EQ(row[1], 1.0);
    }
  }
}

TYPED_TEST(PointTest, ReadsTheAirOfAPocketAndDry) {
  constexpr int dim = TypeParam::value;
  using T = Tank<dim>;
  const T tank = T::filled(0.8);
  ProbeContext<dim> context = tank.context();
  context.air_pressure = [](const Vec<dim>& x) { return 100.0 * x[dim - 1]; };
  const Reading<dim> reading = pressure_reading<dim>(probe_at(ProbeType::pressure, T::at(0.5, 1.25)));
  EXPECT_EQ(reading.take(context).at(0), (Row{125.0, 0.0}));
}

TYPED_TEST(PointTest, AirReadsZeroAndDry) {
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.8);
  for (const double z : {0.85, 1.4, 50.0}) {
    EXPECT_EQ(TestFixture::pressure(tank, T::at(0.5, z)), (Row{0.0, 0.0})) << z;
  }
}

TYPED_TEST(PointTest, ASheetOneParticleThickReadsItsMean) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  // Against a wall a single layer counts as water but spans no normal direction: the fit is singular there.
  T tank(0.0, [](const Vec<dim>& x) { return x[0] > 1.0 - T::dx; });
  for (double& p : tank.particles.pressure) p = 700.0;
  const Row row = TestFixture::pressure(tank, T::at(1.0, 0.6));
  EXPECT_NEAR(row[0], 700.0, 700.0 * 1e-13);
  EXPECT_EQ(row[1], 1.0);
}

TYPED_TEST(PointTest, VelocityIsReadComponentByComponent) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  T tank = T::filled(0.8);
  Mat<dim> gradient = Mat<dim>::Zero();
  for (int a = 0; a < dim; ++a) {
    for (int b = 0; b < dim; ++b) gradient(a, b) = 1.0 + 2.0 * a - 3.0 * b * b;
  }
  for (std::size_t i = 0; i < tank.particles.size(); ++i) {
    tank.particles.velocity[i] = gradient * tank.particles.position[i];
  }
  const Coordinates at = T::at(0.513, 0.37);
  const auto reading = velocity_reading<dim>(probe_at(ProbeType::velocity, at), tank.spec);
  EXPECT_EQ(reading.columns.size(), dim + 1u);
  const Row row = reading.take(tank.context()).at(0);
  const Vec<dim> expected = gradient * Vec<dim>::Map(at.data());
  for (int d = 0; d < dim; ++d) {
    EXPECT_NEAR(row[d], expected[d], 1e-10) << d;
  }
  EXPECT_EQ(row[dim], 1.0);
  const auto dry = velocity_reading<dim>(probe_at(ProbeType::velocity, T::at(0.5, 1.2)), tank.spec);
  EXPECT_EQ(dry.take(tank.context()).at(0), Row(dim + 1, 0.0));
}

// A shear of 2 1/s along x, beside the floor too, of a Bingham liquid: 5 Pa + 3 Pa s times 2 1/s.
TYPED_TEST(PointTest, TheStressOfALiquidIsThatOfItsLaw) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  T tank = T::filled(0.8);
  fill_with(tank.spec, bingham(3.0, 5.0));
  for (std::size_t i = 0; i < tank.particles.size(); ++i) {
    tank.particles.velocity[i][0] = 2.0 * tank.particles.position[i][dim - 1];
  }
  for (const double z : {0.0, 0.37}) {
    ProbeTable probe = probe_at(ProbeType::velocity, T::at(0.513, z));
    probe.liquid = "liquid";
    const Row row = velocity_reading<dim>(probe, tank.spec).take(tank.context()).at(0);
    ASSERT_EQ(row.size(), dim + 4u);
    EXPECT_NEAR(row[dim + 1], 2.0, 1e-10);
    EXPECT_NEAR(row[dim + 2], 5.5, 1e-10);
    EXPECT_NEAR(row[dim + 3], 11.0, 1e-10);
  }
}

}  // namespace
}  // namespace tailwater
