#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "motion/bound_waves.h"
#include "motion/wave_theory.h"
#include "motion/wave_water.h"

namespace tailwater {
namespace {

using wave_water::g;
using wave_water::h;
using wave_water::omega_at;

struct Velocity {
  double along, upward;
};

TravellingWave wave_at(double omega, double amplitude) { return {omega, wave_number(omega, g, h), amplitude}; }

/// The velocity of the bound waves for angles `theta` of the waves.
Velocity velocity_of(const BoundWaves& bound, const std::vector<TravellingWave>& waves,
                     const std::vector<double>& theta, double z) {
  BoundFlow flow(bound, z);
  for (std::size_t n = 0; n < waves.size(); ++n) {
    flow.add(std::cos(theta[n]), std::sin(theta[n]), DepthShape(waves[n].wave_number, z, h));
  }
  const auto [along, upward] = flow.velocity();
  return {along, upward};
}

std::vector<double> angles_at(const std::vector<TravellingWave>& waves, double x, double t) {
  std::vector<double> theta;
  for (const TravellingWave& wave : waves) theta.push_back(wave.omega * t - wave.wave_number * x);
  return theta;
}

// Stokes: u = 3/4 a^2 omega k cosh 2kz/sinh^4 kh.
TEST(BoundWaves, OfOneWaveAreItsSecondHarmonic) {
  for (const double kh : {0.5, 1.0, 3.0}) {
    const double k = kh / h;
    const std::vector<TravellingWave> waves{wave_at(omega_at(kh), 0.01)};
    const BoundWaves bound(waves, g, h);
    const double scale = 0.75e-4 * omega_at(kh) * k / std::pow(std::sinh(kh), 4);
    for (const double z : {0.0, 0.3 * h, h}) {
      const Velocity u = velocity_of(bound, waves, {0.3}, z);
      EXPECT_NEAR(u.along, scale * std::cosh(2.0 * k * z) * std::cos(0.6), 1e-9 * scale * std::cosh(2.0 * kh));
      EXPECT_NEAR(u.upward, -scale * std::sinh(2.0 * k * z) * std::sin(0.6), 1e-9 * scale * std::cosh(2.0 * kh));
    }
  }
}

// Longuet-Higgins & Stewart (1962): the long wave -g a b (2n - 1/2)/(gh - c_g^2) under a group takes the discharge c_g
// eta with it. The crests carry a b omega/tanh kh of it, the water below the rest.
TEST(BoundWaves, OfTwoCloseFrequenciesAreTheLongWaveOfRadiationStress) {
  for (const double kh : {0.5, 1.0, 2.0}) {
    const double a = 0.01;
    const double b = 0.007;
    const double omega = omega_at(kh);
    const std::vector<TravellingWave> waves{wave_at(0.995 * omega, a), wave_at(1.005 * omega, b)};
    const BoundWaves bound(waves, g, h);
    const double k = kh / h;
    const double group = 0.01 * omega / (waves[1].wave_number - waves[0].wave_number);
    const double long_wave = -g * a * b * (2.0 * group * k / omega - 0.5) / (g * h - group * group);
    const double expected = (group * long_wave - a * b * omega / std::tanh(kh)) / h;
    // A quarter of a period later the sums have the opposite sign.
    const double quarter = 0.5 * std::numbers::pi;
    for (const double z : {0.2 * h, h}) {
      const double now = velocity_of(bound, waves, {0.4, 0.4}, z).along;
      const double later = velocity_of(bound, waves, {0.4 + quarter, 0.4 + quarter}, z).along;
      EXPECT_NEAR(0.5 * (now + later) / expected, 1.0, 2e-3) << kh;
    }
  }
}

// The condition at the surface to second order, phi_tt + g phi_z = -(u^2 + w^2)_t + phi_t (phi_tt + g phi_z)_z/g with
// the potential of first order on the right, derived along x: u_tt + g w_x = F_x.
TEST(BoundWaves, FulfilTheConditionsAtTheSurface) {
  for (const double kh : {0.4, 1.0, 3.0, 8.0}) {
    const double omega = omega_at(kh);
    const std::vector<TravellingWave> waves{wave_at(0.7 * omega, 0.01), wave_at(1.2 * omega, 0.013),
                                            wave_at(1.6 * omega, 0.008)};
    const BoundWaves bound(waves, g, h);
    // The potential is -g a/omega cosh kz/cosh kh sin theta.
    enum class Part { along, upward, in_time, excess_slope };
    const auto first_order = [&](Part part, double x, double t) {
      double sum = 0.0;
      const std::vector<double> theta = angles_at(waves, x, t);
      for (std::size_t n = 0; n < waves.size(); ++n) {
        const auto [w, k, a] = waves[n];
        const double slope = k * std::tanh(k * h);
        switch (part) {
          case Part::along:
            sum += g * a / w * k * std::cos(theta[n]);
            break;
          case Part::upward:
            sum -= g * a / w * slope * std::sin(theta[n]);
            break;
          case Part::in_time:
            sum -= g * a * std::cos(theta[n]);
            break;
          case Part::excess_slope:
            sum -= g * a / w * (g * k * k - w * w * slope) * std::sin(theta[n]);
            break;
        }
      }
      return sum;
    };
    const double e = 1e-4 / omega;
    const double d = 1e-4 / wave_number(omega, g, h);
    const auto square = [&](double x, double t) {
      return std::pow(first_order(Part::along, x, t), 2) + std::pow(first_order(Part::upward, x, t), 2);
    };
    const auto forcing = [&](double x, double t) {
      return -(square(x, t + e) - square(x, t - e)) / (2.0 * e) +
             first_order(Part::in_time, x, t) * first_order(Part::excess_slope, x, t) / g;
    };
    const auto velocity_at = [&](double x, double t) { return velocity_of(bound, waves, angles_at(waves, x, t), h); };
    double largest = 0.0;
    double error = 0.0;
    for (double t = 0.0; t < 10.0; t += 0.37) {
      const double x = 0.2;
      const double force = (forcing(x + d, t) - forcing(x - d, t)) / (2.0 * d);
      const double accelerating =
          (velocity_at(x, t + 100.0 * e).along - 2.0 * velocity_at(x, t).along + velocity_at(x, t - 100.0 * e).along) /
          (1e4 * e * e);
      const double falling = g * (velocity_at(x + d, t).upward - velocity_at(x - d, t).upward) / (2.0 * d);
      error = std::max(error, std::abs(accelerating + falling - force));
      largest = std::max(largest, std::abs(force));
    }
    EXPECT_LT(error, 1e-3 * largest) << kh;
  }
}

// A flow without divergence and, at the bed, without a velocity across it.
TEST(BoundWaves, AreAFlowOfWater) {
  const double omega = omega_at(1.0);
  const std::vector<TravellingWave> waves{wave_at(0.8 * omega, 0.01), wave_at(omega, 0.01), wave_at(1.3 * omega, 0.01)};
  const BoundWaves bound(waves, g, h);
  const auto at = [&](double x, double z) { return velocity_of(bound, waves, angles_at(waves, x, 0.7), z); };
  const double e = 1e-5;
  const double x = 0.3;
  const double z = 0.6 * h;
  const double stretching = (at(x + e, z).along - at(x - e, z).along) / (2.0 * e);
  const double rising = (at(x, z + e).upward - at(x, z - e).upward) / (2.0 * e);
  EXPECT_GT(std::abs(stretching), 1e-4);
  EXPECT_NEAR(stretching + rising, 0.0, 1e-6 * std::abs(stretching));
  EXPECT_NEAR(at(x, 0.0).upward, 0.0, 1e-15);
}

// Each pair of many waves by itself, which eight eigenvalues represent exactly. The difference, rms over 20 times, is
// that of the eigenvalues left out, 0.8 % of the velocity at the surface.
TEST(BoundWaves, OfManyWavesAreThoseOfAllPairs) {
  for (const double kh : {0.5, 1.0, 5.0}) {
    std::vector<TravellingWave> waves;
    std::vector<double> phases;
    for (std::uint64_t n = 0; n < 60; ++n) {
      const double f = 0.6 + 0.03 * (static_cast<double>(n) + 0.4 * random_number(1, n, 0));
      waves.push_back(wave_at(f * omega_at(kh), 0.002 * std::exp(-6.0 * (f - 1.0) * (f - 1.0))));
      phases.push_back(std::numbers::pi * random_number(1, n, 1));
    }
    const BoundWaves bound(waves, g, h);
    std::vector<BoundWaves> alone;
    std::vector<BoundWaves> pairs;
    for (std::size_t n = 0; n < waves.size(); ++n) {
      alone.emplace_back(std::vector{waves[n]}, g, h);
      for (std::size_t m = 0; m < n; ++m) pairs.emplace_back(std::vector{waves[m], waves[n]}, g, h);
    }
    double size = 0.0;  // at the surface
    for (const double z : {h, 0.5 * h}) {
      double error = 0.0;
      for (int time = 0; time < 20; ++time) {
        std::vector<double> theta = angles_at(waves, 0.0, 1.7 * time);
        for (std::size_t n = 0; n < waves.size(); ++n) theta[n] += phases[n];
        const Velocity all = velocity_of(bound, waves, theta, z);
        Velocity sum{0.0, 0.0};
        const auto add = [&](const Velocity& u, double factor) {
          sum.along += factor * u.along;
          sum.upward += factor * u.upward;
        };
        auto pair = pairs.begin();
        for (std::size_t n = 0; n < waves.size(); ++n) {
          // Each of its pairs contains the sum of the wave with itself.
          const double others = static_cast<double>(waves.size()) - 1.0;
          add(velocity_of(alone[n], {waves[n]}, {theta[n]}, z), 1.0 - others);
          for (std::size_t m = 0; m < n; ++m) {
            add(velocity_of(*pair++, {waves[m], waves[n]}, {theta[m], theta[n]}, z), 1.0);
          }
        }
        error += std::pow(all.along - sum.along, 2) + std::pow(all.upward - sum.upward, 2);
        if (z == h) size += std::pow(sum.along, 2) + std::pow(sum.upward, 2);
      }
      EXPECT_LT(std::sqrt(error / size), 0.02) << kh << ' ' << z;
    }
  }
}

}  // namespace
}  // namespace tailwater
