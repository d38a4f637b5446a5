#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/error.h"
#include "geometry/cases.h"
#include "motion/second_order.h"
#include "motion/wave_maker.h"
#include "motion/wave_theory.h"
#include "motion/wave_water.h"

namespace tailwater {
namespace {

using wave_water::g;
using wave_water::h;
using wave_water::omega_at;

WaveMakerTable maker_of(WaveKind waves, double height, double period) {
  WaveMakerTable maker;
  maker.from = {0.0, 0.0};
  maker.to = {0.0, 0.8};
  maker.depth = h;
  maker.waves = waves;
  maker.height = height;
  maker.period = period;
  maker.ramp = 2.0 * period;
  return maker;
}

TEST(WaveTheory, TheWaveNumberSolvesTheDispersionRelation) {
  for (const double kh : {1e-3, 0.1, 1.0, 3.0, 50.0}) EXPECT_NEAR(wave_number(omega_at(kh), g, h) * h / kh, 1.0, 1e-12);
}

// Long waves: a piston's is kh of its stroke (Galvin 1964), a flap's half of it, with errors of O(kh^2). Deep water:
// both make waves of twice the stroke, but for the 1/kh by which a flap's motion decreases within a wave's reach.
TEST(WaveTheory, APlateMakesTheKnownWavesInShallowAndInDeepWater) {
  EXPECT_NEAR(maker_transfer(MakerType::piston, omega_at(0.01), g, h).wave / 0.01, 1.0, 1e-4);
  EXPECT_NEAR(maker_transfer(MakerType::flap, omega_at(0.01), g, h).wave / 0.01, 0.5, 1e-4);
  EXPECT_NEAR(maker_transfer(MakerType::piston, omega_at(50.0), g, h).wave, 2.0, 1e-12);
  EXPECT_NEAR(maker_transfer(MakerType::flap, omega_at(50.0), g, h).wave, 2.0 * (1.0 - 1.0 / 50.0), 1e-12);
}

TEST(WaveTheory, TheNearFieldBelongsToTheModesThatDoNotTravel) {
  const double omega = omega_at(1.0);
  const MakerTransfer transfer = maker_transfer(MakerType::piston, omega, g, h);
  for (const auto& term : transfer.near_field) {
    const double y = term.wave_number * h;
    EXPECT_NEAR(-y * std::tan(y), omega * omega * h / g, 1e-9);
  }
  // Half a depth away nothing but the first mode is left.
  const auto& first = transfer.near_field.front();
  EXPECT_NEAR(transfer.near_field_at(h) / (first.share * std::exp(-first.wave_number * h)), 1.0, 0.01);
}

// Where the plate has been, the wave's water is: the stroke is the wave's volume over the depth.
TEST(MakerLaw, OfASolitaryWaveMovesWithTheWaterUnderIt) {
  const double H = 0.1;
  const MakerLaw law(maker_of(WaveKind::solitary, H, 0.0), g, 0.0);
  const double beta = std::sqrt(0.75 * H / (h * h * (h + H)));
  const double c = std::sqrt(g * (h + H));
  EXPECT_EQ(law.stroke(0.0), 0.0);
  EXPECT_NEAR(law.stroke(30.0), 2.0 * H / (beta * h) * 0.9995, 2.0 * H / (beta * h) * 0.0006);  // tanh(3.8) = 0.9990
  const double e = 1e-5;
  double highest = 0.0;
  for (double t = 0.1; t < 4.0; t += 0.1) {
    const double eta = law.elevation(t);
    EXPECT_NEAR((law.stroke(t + e) - law.stroke(t - e)) / (2.0 * e), c * eta / (h + eta), 1e-8);
    highest = std::max(highest, eta);
  }
  EXPECT_NEAR(highest, H, 0.02 * H);
}

// In long waves the plate moves with the water, h dX/dt = c eta, at second order as well: the bound wave of Stokes has
// the amplitude 3 H^2/(16 k^2 h^3) there, and the plate's second harmonic is c/(2 omega h) of it, up to O(kh^2).
TEST(MakerLaw, OfSecondOrderFollowsTheBoundWave) {
  WaveMakerTable maker = maker_of(WaveKind::regular, 0.001, 2.0 * std::numbers::pi / omega_at(0.1));
  const double k = 0.1 / h;
  const double omega = 2.0 * std::numbers::pi / maker.period;
  const MakerLaw law(maker, g, 0.0);
  const double first = 0.5 * maker.height / maker_transfer(MakerType::piston, omega, g, h).wave;
  // An eighth of a period after full periods, where sin(2 omega t) = 1; a quarter after them it is 0.
  const double t = 10.125 * maker.period;
  const double bound = 3.0 * maker.height * maker.height / (16.0 * k * k * h * h * h);
  const double expected = bound * omega / k / (2.0 * omega * h);
  EXPECT_NEAR((law.stroke(t) - first * std::sin(omega * t)) / expected, 1.0, 0.02);
  EXPECT_NEAR(law.stroke(10.25 * maker.period) / first, 1.0, 1e-9);
}

// Madsen (1971), (20), has the limit of long waves; there a flap moves half as much water as a piston.
TEST(SecondOrder, HasTheLimitsOfLongWaves) {
  const double omega = omega_at(0.1);
  const double height = 0.1 * h;
  const double stroke = 0.5 * height / maker_transfer(MakerType::piston, omega, g, h).wave;
  const std::complex<double> second = second_harmonic(MakerType::piston, {omega, {0.0, -stroke}}, g, h).stroke;
  const double sinh_y = std::sinh(0.1);
  const double madsen = height * height / (32.0 * h) *
                        (3.0 * std::cosh(0.1) / (sinh_y * sinh_y * sinh_y) - 2.0 * stroke / (0.5 * height));
  EXPECT_NEAR(-second.imag() / madsen, 1.0, 2e-4);
  EXPECT_NEAR(second.real() / madsen, 0.0, 1e-6);
  const double slow = omega_at(0.02);
  const auto second_of = [&](MakerType type) {
    const double x = 0.5 * height / maker_transfer(type, slow, g, h).wave;
    return second_harmonic(type, {slow, {0.0, -x}}, g, h).stroke.imag();
  };
  EXPECT_NEAR(second_of(MakerType::flap) / second_of(MakerType::piston), 2.0, 0.01);
}

// The integrals over the depth in closed form against the same sums with quadrature by 8000 midpoints (a script in
// Python) and with 60 and 120 modes, extrapolated, at kh = 1 and H = 0.1 h.
TEST(SecondOrder, AgreesWithItsIntegralsByQuadrature) {
  const double omega = omega_at(1.0);
  const auto second_of = [&](MakerType type) {
    const double x = 0.05 * h / maker_transfer(type, omega, g, h).wave;
    return second_harmonic(type, {omega, {0.0, -x}}, g, h).stroke;
  };
  const std::complex<double> piston(3.54299e-5, -3.637497e-4);
  const std::complex<double> flap(-3.459988e-4, 7.310625e-4);
  EXPECT_LT(std::abs(second_of(MakerType::piston) - piston), 2e-3 * std::abs(piston));
  EXPECT_LT(std::abs(second_of(MakerType::flap) - flap), 2e-3 * std::abs(flap));
}

std::vector<SecondOrderWave> waves_of_pair(MakerType type, double kh, double difference) {
  const double omega = omega_at(kh);
  const std::array<PlateMotion, 2> motions{PlateMotion{omega * (1.0 - 0.5 * difference), 0.01},
                                           PlateMotion{omega * (1.0 + 0.5 * difference), 0.01}};
  return second_order_waves(type, motions, 0.0, g, h);
}

// The mean flow under a long group: the bound wave of radiation stress (Longuet-Higgins & Stewart 1962), -g a b (2n -
// 1/2)/(gh - c_g^2), takes the discharge c_g eta with it, which the plate displaces. A flap displaces half of its
// stroke.
TEST(SecondOrder, OfDifferencesMovesTheWaterOfTheBoundWave) {
  for (const double kh : {0.5, 1.0, 2.0}) {
    const double difference = 0.02;
    const double slow = omega_at(kh) * (1.0 - 0.5 * difference);
    const double fast = omega_at(kh) * (1.0 + 0.5 * difference);
    const double group = (fast - slow) / (wave_number(fast, g, h) - wave_number(slow, g, h));
    const double n = group * wave_number(omega_at(kh), g, h) / omega_at(kh);
    for (const MakerType type : {MakerType::piston, MakerType::flap}) {
      const double a = 0.01 * maker_transfer(type, slow, g, h).wave;
      const double b = 0.01 * maker_transfer(type, fast, g, h).wave;
      const double bound = -g * a * b * (2.0 * n - 0.5) / (g * h - group * group);
      const std::vector<SecondOrderWave> waves = waves_of_pair(type, kh, difference);
      const auto slowest = std::ranges::min_element(waves, {}, &SecondOrderWave::omega);
      EXPECT_NEAR(slowest->omega, fast - slow, 1e-9);
      EXPECT_NEAR(slowest->elevation.real() / bound, 1.0, 2e-3) << kh;
      const double mean_stroke = type == MakerType::flap ? 0.5 : 1.0;
      const std::complex<double> discharge =
          std::complex<double>(0.0, slowest->omega) * slowest->stroke * mean_stroke * h;
      EXPECT_LT(std::abs(discharge / (group * bound) - 1.0), 0.01) << kh;
    }
  }
}

// Two motions of nearly one frequency are one of twice the stroke, whose harmonic is four times that of each: two from
// the pair and one from each of them. The bound wave is that of Stokes.
TEST(SecondOrder, OfSumsIsThatOfOneMotionInTheLimit) {
  for (const MakerType type : {MakerType::piston, MakerType::flap}) {
    const std::vector<SecondOrderWave> waves = waves_of_pair(type, 1.0, 1e-4);
    ASSERT_EQ(waves.size(), 4u);  // three sums and a difference
    const double omega = omega_at(1.0);
    const SecondOrderWave one = second_harmonic(type, {omega, 0.01}, g, h);
    for (const SecondOrderWave& wave : waves) {
      if (wave.omega < omega) continue;
      const double expected = std::abs(wave.omega - 2.0 * omega) < 1e-9 ? 2.0 : 1.0;
      EXPECT_LT(std::abs(wave.stroke / one.stroke - expected), 2e-3);
    }
    const double a = 0.01 * maker_transfer(type, omega, g, h).wave;
    const double sinh_y = std::sinh(1.0);
    const double stokes = a * a / h / 4.0 * std::cosh(1.0) * (2.0 + std::cosh(2.0)) / (sinh_y * sinh_y * sinh_y);
    // The wave of the stroke is i times it.
    EXPECT_NEAR(one.elevation.real() / -stokes, 1.0, 1e-9);
    EXPECT_NEAR(one.elevation.imag() / stokes, 0.0, 1e-9);
  }
}

TEST(MakerLaw, OfAnNWaveMovesBackAndForthWithTheWaterUnderIt) {
  for (const double H : {0.1 * h, 0.6 * h}) {
    const MakerLaw law(maker_of(WaveKind::n_wave, H, 0.0), g, 0.0);
    const double c = std::sqrt(g * h);
    const double e = 1e-5;
    double highest = 0.0, lowest = 0.0, time_of_lowest = 0.0, time_of_highest = 0.0;
    for (double t = 0.1; t < 6.0; t += 0.01) {
      const double eta = law.elevation(t);
      EXPECT_NEAR((law.stroke(t + e) - law.stroke(t - e)) / (2.0 * e), c * eta / (h + eta), 1e-7);
      if (eta > highest) highest = eta, time_of_highest = t;
      if (eta < lowest) lowest = eta, time_of_lowest = t;
    }
    EXPECT_NEAR(highest, H, 0.01 * H);
    EXPECT_NEAR(lowest, -H, 0.01 * H);
    EXPECT_LT(time_of_lowest, time_of_highest);
    EXPECT_NEAR(law.stroke(30.0), 0.0, 1e-3 * H);
  }
}

TEST(MakerLaw, OfIrregularWavesHasTheSignificantHeightAndASeed) {
  WaveMakerTable maker = maker_of(WaveKind::jonswap, 0.05, 1.2);
  const MakerLaw law(maker, g, 0.0);
  EXPECT_EQ(law.stroke(0.0), 0.0);
  // 4 rms over 2000 periods; with 200 components its own scatter is below 1 %.
  double sum = 0.0;
  int count = 0;
  for (double t = 10.0; t < 2400.0; t += 0.9) {
    const double eta = law.elevation(t);
    sum += eta * eta;
    ++count;
  }
  // The elevation at the plate has the near field as well, a few percent.
  EXPECT_NEAR(4.0 * std::sqrt(sum / count) / maker.height, 1.0, 0.05);
  const double before = law.stroke(31.0);
  EXPECT_EQ(MakerLaw(maker, g, 0.0).stroke(31.0), before);
  maker.seed = 2;
  EXPECT_NE(MakerLaw(maker, g, 0.0).stroke(31.0), before);
}

TEST(MakerLaw, GivesWayAsTheTheoryOfItsPeriodSays) {
  WaveMakerTable maker = maker_of(WaveKind::none, 0.0, 0.0);
  EXPECT_NEAR(MakerLaw(maker, g, 0.0).gain(), std::sqrt(g / h), 1e-12);
  maker.type = MakerType::flap;
  EXPECT_NEAR(MakerLaw(maker, g, 0.0).gain(), 2.0 * std::sqrt(g / h), 1e-12);
  maker.period = 1000.0;
  EXPECT_NEAR(MakerLaw(maker, g, 0.0).gain() / (2.0 * std::sqrt(g / h)), 1.0, 1e-3);
}

TEST(WavePlate, OfWavesThatBreakIsRefused) {
  const CaseSpec spec = testing_cases::empty_case(0.1);
  // In deep water 0.142 of g T^2/(2 pi).
  const double highest = 0.142 * g * 0.25 * 0.25 / (2.0 * std::numbers::pi);
  EXPECT_NO_THROW(WavePlate<2>(spec, maker_of(WaveKind::regular, 0.999 * highest, 0.25)));
  EXPECT_THROW(WavePlate<2>(spec, maker_of(WaveKind::regular, 1.001 * highest, 0.25)), InputError);
}

TEST(WavePlate, TooLowOrFlatIsRefused) {
  CaseSpec spec = testing_cases::empty_case(0.1);
  WaveMakerTable maker = maker_of(WaveKind::regular, 0.05, 1.2);
  EXPECT_NO_THROW(WavePlate<2>(spec, maker));
  maker.to = {0.0, 0.3};
  EXPECT_THROW(WavePlate<2>(spec, maker), InputError);
  maker.to = {0.8, 0.0};
  maker.side = AxisDirection::minus_y;
  EXPECT_THROW(WavePlate<2>(spec, maker), InputError);
}

}  // namespace
}  // namespace tailwater
