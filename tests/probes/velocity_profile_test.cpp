#include "probes/velocity_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "probes/discharge.h"
#include "probes/tank.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class Dimension>
class VelocityProfileTest : public testing::Test {
 public:
  static constexpr int dimension = Dimension::value;
  using TankOf = Tank<dimension>;

  /// Water up to 0.6 m with a linear shear, (1 + 2 z, .., -3).
  static TankOf shearing() {
    TankOf tank = TankOf::filled(0.6);
    for (std::size_t i = 0; i < tank.particles.size(); ++i) {
      tank.particles.velocity[i][0] = 1.0 + 2.0 * tank.particles.position[i][dimension - 1];
      tank.particles.velocity[i][dimension - 1] = -3.0;
    }
    return tank;
  }
  static TankOf moving(double level, double speed) {
    TankOf tank = TankOf::filled(level);
    for (Vec<dimension>& u : tank.particles.velocity) u[0] = speed;
    return tank;
  }
};
TYPED_TEST_SUITE(VelocityProfileTest, Dimensions);

/// The interpolation is exact for linear fields, and so is the mean over pieces by the midpoint rule.
TYPED_TEST(VelocityProfileTest, OfALinearShearIsExact) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const T tank = TestFixture::shearing();
  ProbeTable probe = probe_at(ProbeType::velocity_profile, T::at(0.5, 0.3));
  probe.step = 0.25;
  const Reading<Dim> reading = velocity_profile_reading<Dim>(probe, tank.spec, tank.boundary);
  ASSERT_EQ(reading.columns.size(), 2u + 2u * Dim);
  EXPECT_EQ(reading.columns.back().heading, Dim == 2 ? "mean_v_m_s" : "mean_w_m_s");
  const std::vector<Row> rows = reading.take(tank.context(0.0));
  ASSERT_EQ(rows.size(), 3u);
  const double depth = rows[0][1 + Dim];
  EXPECT_NEAR(depth, 0.6, 0.05 * T::dx);
  const std::vector<double> heights{0.125, 0.375, 0.5 * (0.5 + depth)};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_NEAR(rows[k][0], heights[k], 1e-12);
    EXPECT_NEAR(rows[k][1], 1.0 + 2.0 * heights[k], 1e-10);
    EXPECT_NEAR(rows[k][Dim], -3.0, 1e-10);
    EXPECT_NEAR(rows[k][2 + Dim], 1.0 + depth, 1e-10);
    EXPECT_NEAR(rows[k].back(), -3.0, 1e-10);
  }
}

TYPED_TEST(VelocityProfileTest, SumsUpTheMeanOverTime) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.6);
  const ProbeTable probe = probe_at(ProbeType::velocity_profile, T::at(0.5, 0.0));
  const Reading<Dim> reading = velocity_profile_reading<Dim>(probe, tank.spec, tank.boundary);
  reading.take(tank.context(0.0));
  reading.take(TestFixture::moving(0.6, 2.0).context(1.0));
  reading.take(TestFixture::moving(0.6, 5.0).context(4.0));
  const std::vector<double> totals = reading.totals();
  ASSERT_EQ(totals.size(), totals_of(ProbeType::velocity_profile, Dim).size());
  EXPECT_NEAR(totals[0], 0.6, 0.05 * T::dx);
  EXPECT_NEAR(totals[1], (2.0 * 1.0 + 5.0 * 3.0) / 4.0, 1e-10);
}

TYPED_TEST(VelocityProfileTest, OfADryBedIsARowOfZeros) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  const T tank = T::filled(0.0);
  const ProbeTable probe = probe_at(ProbeType::velocity_profile, T::at(0.5, 0.0));
  const Reading<Dim> reading = velocity_profile_reading<Dim>(probe, tank.spec, tank.boundary);
  EXPECT_EQ(reading.take(tank.context()), std::vector<Row>{Row(2 + 2 * Dim, 0.0)});
}

/// Overtopping of a crest 0.4 m high: a section from the crest up, H = 1 m high. Water 0.8 m high is a whole number of
/// rows, which the linear weights count exactly. The discharge is the mean over T = 20 dx/sqrt(g H), or since the
/// reading before. A mean over less than T, at the start, is no largest one.
TYPED_TEST(VelocityProfileTest, DischargeOverACrestKeepsItsLargestWholeMean) {
  constexpr int Dim = TestFixture::dimension;
  using T = typename TestFixture::TankOf;
  T tank = T::filled(0.8);
  ProbeTable crest = probe_along(ProbeType::discharge, Coordinates(Dim, 0.0), Coordinates(Dim, T::width));
  crest.from[0] = crest.to[0] = 0.5;
  crest.from.back() = 0.4;
  crest.to.back() = 1.4;
  crest.direction.assign(Dim, 0.0);
  crest.direction[0] = 1.0;
  tank.spec.probes = {crest};
  const Reading<Dim> reading = discharge_reading<Dim>(crest, tank.spec);
  const auto discharge_at = [&](double time, double speed, double passed) {
    const T flow = TestFixture::moving(0.8, speed);
    ProbeContext<Dim> context = flow.context(time);
    context.totals.section_volumes = {passed};
    return reading.take(context).at(0)[0];
  };
  const double over = 20.0 * T::dx / std::sqrt(T::g * 1.0);
  ASSERT_GT(over, 0.15);
  ASSERT_LT(over, 0.85);
  const double at_start = 0.4 * 0.5;  // from the velocity of the water, since no volume has been counted yet
  EXPECT_NEAR(discharge_at(0.0, 0.5, 0.0), at_start, 1e-12);
  EXPECT_NEAR(discharge_at(0.1, 2.0, 0.08), 0.8, 1e-12);
  EXPECT_NEAR(discharge_at(0.15, 0.0, 0.14), 0.14 / 0.15, 1e-12);
  EXPECT_EQ(reading.totals()[0], 0.0);
  EXPECT_NEAR(discharge_at(1.0, 2.0, 0.565), 0.5, 1e-12);  // from the reading at 0.15 s on the rate is 0.5
  EXPECT_NEAR(discharge_at(2.0, -3.0, -0.4), -0.965, 1e-12);
  const std::vector<double> totals = reading.totals();
  ASSERT_EQ(totals.size(), totals_of(ProbeType::discharge, Dim).size());
  EXPECT_NEAR(totals[0], 0.5, 1e-12);
  EXPECT_EQ(totals[1], 1.0);
  EXPECT_NEAR(totals[2], over, 1e-12);
}

}  // namespace
}  // namespace tailwater
