#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "geometry/cases.h"
#include "motion/regular_wave.h"
#include "motion/wave_field.h"
#include "motion/wave_theory.h"
#include "motion/wave_water.h"
#include "motion/wave_zone.h"

namespace tailwater {
namespace {

using wave_water::g;
using wave_water::h;
using wave_water::omega_at;
constexpr double pi = std::numbers::pi;

RegularWave wave_of(double kh, double height, double transport = 0.0) {
  return RegularWave::solve({height, 2.0 * pi / omega_at(kh), h, g, transport}).value();
}

// Stokes: the second harmonic is k H^2/16 cosh kh (2 + cosh 2kh)/sinh^3 kh, and the phase speed grows by a term of
// second order.
TEST(RegularWave, BecomesTheWaveOfStokesWhereItIsLow) {
  for (const double kh : {0.7, 1.0, 3.0}) {
    const double height = 0.004 * h;
    const RegularWave wave = wave_of(kh, height);
    EXPECT_NEAR(wave.amplitude(1) / (0.5 * height), 1.0, 1e-3);
    const double k = kh / h;
    const double s = std::sinh(kh);
    const double second = k * height * height / 16.0 * std::cosh(kh) * (2.0 + std::cosh(2.0 * kh)) / (s * s * s);
    EXPECT_NEAR(wave.amplitude(2) / second, 1.0, 0.01);
    EXPECT_NEAR(wave.wave_number() / k, 1.0, 1e-3);
  }
}

// The series satisfies Bernoulli's equation at its points. Between them the error shows whether it is long enough.
TEST(RegularWave, SatisfiesBernoullisEquationUpToHalfOfTheBreakingHeight) {
  for (const double kh : {0.3, 0.5, 1.0, 2.0, 5.0}) {
    const double height = 0.5 * std::min(breaking_height(omega_at(kh), g, h), 0.78 * h);
    const RegularWave wave = wave_of(kh, height);
    EXPECT_LT(wave.residual(), 1e-4 * height * omega_at(kh)) << kh;
    EXPECT_NEAR(wave.elevation(0.0) - wave.elevation(pi), height, 1e-9);
  }
}

TEST(RegularWave, HasTheTransportThatWasAskedFor) {
  for (const double transport : {0.0, 0.1}) {
    const RegularWave wave = wave_of(1.0, 0.2 * h, transport);
    double discharge = 0.0;
    constexpr int places = 64;
    constexpr int heights = 400;
    for (int m = 0; m < places; ++m) {
      const double phase = 2.0 * pi * m / places;
      const double level = h + wave.elevation(phase);
      for (int n = 0; n < heights; ++n) {
        discharge += wave.velocity(phase, (n + 0.5) / heights * level)[0] * level / (heights * places);
      }
    }
    EXPECT_NEAR(discharge, transport * h, 1e-5 * std::sqrt(g * h) * h);
  }
}

// A high wave in shallow water is nearly solitary: its crest runs with the speed of a solitary wave of the height above
// the trough's level.
TEST(RegularWave, IsNearlySolitaryWhereItIsLong) {
  const double height = 0.2 * h;
  const RegularWave wave = wave_of(0.3, height);
  const double trough = h + wave.elevation(pi);
  const double ratio = height / trough;
  const double speed = std::sqrt(g * trough * (1.0 + ratio - ratio * ratio / 20.0));
  // The water of the trough flows against the wave.
  const double current = wave.velocity(pi, 0.5 * trough)[0];
  EXPECT_NEAR((wave.celerity() - current) / speed, 1.0, 0.01);
}

TEST(RegularWave, ThatBreaksIsNone) {
  const double highest = std::min(breaking_height(omega_at(0.2), g, h), 0.78 * h);
  EXPECT_FALSE(RegularWave::solve({highest, 2.0 * pi / omega_at(0.2), h, g, 0.0}).has_value());
  EXPECT_FALSE(RegularWave::solve({0.9 * h, 2.0 * pi / omega_at(1.0), h, g, 0.0}).has_value());
}

WaveKeys keys_of(WaveKind waves, double height, double period) {
  WaveKeys keys;
  keys.waves = waves;
  keys.height = height;
  keys.period = period;
  keys.ramp = 2.0 * period;
  return keys;
}

// Without divergence, and with the surface moving with the water where the waves are low.
TEST(WaveField, OfSinesIsAFlowOfWaterWithASurface) {
  WaveKeys keys = keys_of(WaveKind::focused, 1e-4 * h, 1.2);
  keys.focus = {2.0, 20.0};
  const WaveField field(keys, CaseLabel("damping"), h, g, 0.0);
  EXPECT_NEAR(field.elevation(2.0, 20.0), 0.5 * keys.height, 1e-9);
  const double e = 1e-4;
  const double t = 20.3;
  const double x = 1.7;
  const double z = 0.8 * h;
  const double divergence = (field.velocity(x + e, z, t)[0] - field.velocity(x - e, z, t)[0] +
                             field.velocity(x, z + e, t)[1] - field.velocity(x, z - e, t)[1]) /
                            (2.0 * e);
  EXPECT_NEAR(divergence, 0.0, 1e-6 * keys.height / h);
  const double rise = (field.elevation(x, t + e) - field.elevation(x, t - e)) / (2.0 * e);
  EXPECT_NEAR(field.velocity(x, h, t)[1] / rise, 1.0, 1e-3);
  EXPECT_EQ(field.velocity(x, z, 0.0).norm(), 0.0);
}

// A sine's crest carries a^2 omega/(2 tanh kh) more than its trough; the field takes that out.
TEST(WaveField, OfIrregularWavesTransportsNothing) {
  const WaveField field(keys_of(WaveKind::jonswap, 0.1 * h, 1.2), CaseLabel("damping"), h, g, 0.0);
  double sum = 0.0, largest = 0.0;
  int count = 0;
  for (double t = 20.0; t < 620.0; t += 0.17, ++count) {
    const double level = h + field.elevation(0.0, t);
    double discharge = 0.0;
    constexpr int heights = 10;
    for (int n = 0; n < heights; ++n)
      discharge += field.velocity(0.0, (n + 0.5) / heights * level, t)[0] * level / heights;
    sum += discharge;
    largest = std::max(largest, std::abs(discharge));
  }
  // Without the current the mean would be g H^2/(32 c h) of the depth, 2 % of the largest here.
  EXPECT_LT(std::abs(sum / count), 0.004 * largest);
}

DampingTable zone_of(double length, double strength) {
  DampingTable zone;
  zone.name = "damping1";
  zone.min = {0.0, 0.0};
  zone.max = {length, 2.0 * h};
  zone.strength = strength;
  zone.depth = h;
  zone.period = 2.0 * pi / omega_at(1.0);
  return zone;
}

// Waves in many directions: water without divergence, whole waves in the period across, and most of them near the mean
// direction.
TEST(WaveField, OfSpreadWavesFitsIntoAPeriodicCase) {
  const double width = 3.0;
  const WaveDirections directions{.mean = 0.3, .spreading = 10.0, .period_across = width};
  const WaveField field(keys_of(WaveKind::jonswap, 1e-4 * h, 1.2), CaseLabel("damping"), h, g, 0.0, directions);
  const double e = 1e-4;
  const double x = 1.7, y = 0.4, z = 0.8 * h, t = 20.3;
  const double divergence =
      (field.velocity(x + e, z, t, y)[0] - field.velocity(x - e, z, t, y)[0] + field.velocity(x, z + e, t, y)[1] -
       field.velocity(x, z - e, t, y)[1] + field.velocity(x, z, t, y + e)[2] - field.velocity(x, z, t, y - e)[2]) /
      (2.0 * e);
  EXPECT_NEAR(divergence, 0.0, 1e-5 * 1e-4);
  EXPECT_NEAR(field.elevation(x, t, y + width), field.elevation(x, t, y), 1e-9 * h);
  double along = 0.0, across = 0.0, squares = 0.0;
  for (double time = 20.0; time < 620.0; time += 0.1) {
    const Vec<3> u = field.velocity(x, h, time, y);
    along += u[0] * u[0];
    across += u[2] * u[2];
    squares += u[0] * u[2];
  }
  // The main axis of the horizontal motion is the mean direction. cos^20 of half the angle has a standard deviation of
  // 0.31; whole waves across and one draw of 200 angles shift the axis.
  EXPECT_NEAR(0.5 * std::atan2(2.0 * squares, along - across), 0.3, 0.1);
  EXPECT_GT(across / along, std::pow(std::tan(0.2), 2));
}

TEST(WaveZone, MakesObliqueWavesOfWholeNumberAcross) {
  CaseSpec spec = testing_cases::empty_case(0.1);
  spec.general.dimension = 3;
  spec.domain.periodic_y = {0.0, 3.0};
  spec.physics.gravity = {0.0, 0.0, -g};
  DampingTable table = zone_of(4.0, 5.0);
  static_cast<WaveKeys&>(table) = keys_of(WaveKind::regular, 0.02, table.period);
  table.min = {0.0, 0.0, 0.0};
  table.max = {4.0, 3.0, 2.0 * h};
  table.towards = AxisDirection::minus_x;
  table.level = h;
  table.direction = 50.0;
  spec.damping = {table};
  const WaveZone<3> zone(spec, table);
  const double k = wave_of(1.0, 0.02).wave_number();
  const double across = 2.0 * pi / 3.0;  // one wave: sine 0.84, for 0.77
  const double along = std::sqrt(k * k - across * across);
  const double t = 10.0 * table.period;
  const Vec<3> crest = zone.target(Vec<3>(4.0, 0.0, h), t);
  EXPECT_GT(crest[0], 0.0);
  EXPECT_NEAR(crest[1] / crest[0], across / along, 1e-9);
  for (const Vec<3>& x : {Vec<3>(4.0, 3.0, h), Vec<3>(4.0 - 0.7 * across, 0.7 * along, h)}) {
    EXPECT_NEAR((zone.target(x, t) - crest).norm(), 0.0, 1e-9 * crest.norm());
  }
}

// Long waves: g h P'' = -omega (omega + i rate) P. Without damping a wall returns all, through any zone.
TEST(ZoneEstimate, HasTheLimitsOfNoDampingAndOfALongZone) {
  const double omega = omega_at(1.0);
  const double wavelength = 2.0 * pi * h;
  const ZoneEstimate none = estimate_zone(omega, g, h, wavelength, 1e-9);
  EXPECT_NEAR(none.reflection, 1.0, 1e-6);
  EXPECT_NEAR(none.leak, 1.0, 1e-6);
  const ZoneEstimate weak = estimate_zone(omega, g, h, wavelength, 0.01 * omega);
  // Energy decays at the rate, over the time length/c_g there and back: the amplitude by its half, with the mean 1/3.
  const double group = 0.5 * omega / (1.0 / h) * (1.0 + 2.0 / std::sinh(2.0));
  const double lost = 0.5 * 0.01 * omega / 3.0 * wavelength / group;
  // The rate rises at the wall by 2 0.01 omega per wavelength: over omega k, 0.02/(2 pi), times 2 in a reflection.
  EXPECT_NEAR(weak.reflection, std::exp(-2.0 * lost), 0.0032);
  EXPECT_NEAR(weak.leak, std::exp(-lost), 0.0016);
  EXPECT_LT(estimate_zone(omega, g, h, 6.0 * wavelength, omega).worse(), 1e-3);
}

TEST(ZoneEstimate, OfTheBestStrengthIsSmallForAllDepths) {
  for (const double kh : {0.3, 1.0, 3.0, 5.0}) {
    const double omega = omega_at(kh);
    const double length = 1.5 * 2.0 * pi * h / kh;
    const double strength = best_strength(omega, g, h, length, true);
    EXPECT_LT(estimate_zone(omega, g, h, length, strength).worse(), 0.02) << kh;
  }
}

TEST(WaveZone, GrowsAsTheSquareTowardsItsSide) {
  DampingTable table;
  table.min = {1.0, 0.0};
  table.max = {3.0, 1.0};
  table.strength = 8.0;
  const CaseSpec spec = testing_cases::empty_case(0.1);
  EXPECT_NEAR(WaveZone<2>(spec, table).rate_at({2.0, 0.5}), 2.0, 1e-12);
  EXPECT_EQ(WaveZone<2>(spec, table).rate_at({0.9, 0.5}), 0.0);
  EXPECT_EQ(WaveZone<2>(spec, table).rate_at({2.0, 1.1}), 0.0);
  table.towards = AxisDirection::minus_x;
  EXPECT_NEAR(WaveZone<2>(spec, table).rate_at({1.5, 0.5}), 8.0 * 9.0 / 16.0, 1e-12);
}

TEST(WaveZone, RelaxesToItsWavesWhichRunOutOfIt) {
  CaseSpec spec = testing_cases::empty_case(0.1);
  spec.physics.gravity = {0.0, -g};
  DampingTable table = zone_of(4.0, 5.0);
  static_cast<WaveKeys&>(table) = keys_of(WaveKind::regular, 0.02, table.period);
  table.towards = AxisDirection::minus_x;
  table.level = h;
  spec.damping = {table};
  const WaveZone<2> zone(spec, table);
  EXPECT_EQ(zone.rate_at(Vec<2>(4.0, 0.1)), 0.0);
  EXPECT_EQ(zone.rate_at(Vec<2>(0.0, 0.1)), 5.0);
  EXPECT_EQ(zone.rate_at(Vec<2>(2.0, 0.1)), 1.25);
  const double k = wave_of(1.0, 0.02).wave_number();
  const double t = 10.0 * table.period;
  // A crest at the inner end, and the same water a wavelength behind it.
  EXPECT_GT(zone.target(Vec<2>(4.0, h), t)[0], 0.0);
  EXPECT_NEAR(zone.target(Vec<2>(4.0 - 2.0 * pi / k, h), t)[0] / zone.target(Vec<2>(4.0, h), t)[0], 1.0, 1e-6);
  // A quarter of a period later the surface falls there.
  EXPECT_LT(zone.target(Vec<2>(4.0, h), t + 0.25 * table.period)[1], 0.0);

  table.towards = AxisDirection::plus_x;
  const WaveZone<2> mirrored(spec, table);
  EXPECT_NEAR(mirrored.target(Vec<2>(0.3, 0.2), t)[0], -zone.target(Vec<2>(3.7, 0.2), t)[0], 1e-12);
}

TEST(WaveZone, WithoutAStrengthNeedsAPeriod) {
  CaseSpec spec = testing_cases::empty_case(0.1);
  spec.physics.gravity = {0.0, -g};
  DampingTable table = zone_of(4.0, 0.0);
  EXPECT_NO_THROW(WaveZone<2>(spec, table));
  table.period = 0.0;
  EXPECT_THROW(WaveZone<2>(spec, table), InputError);
}

}  // namespace
}  // namespace tailwater
