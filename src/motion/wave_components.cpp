#include "motion/wave_components.h"

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "motion/wave_theory.h"

namespace tailwater {
namespace {

/// [peak frequency]; between them lie 99.8 % of the energy of a JONSWAP spectrum.
constexpr double lowest_frequency = 0.5;
constexpr double highest_frequency = 3.0;

/// Sines of irregular waves.
constexpr int components = 200;

/// The shape of the JONSWAP spectrum over f/f_p, up to a factor: K. Hasselmann et al. (1973).
double jonswap(double f, double peak_enhancement) {
  const double width = f <= 1.0 ? 0.07 : 0.09;
  const double off = (f - 1.0) / width;
  return std::pow(f, -5.0) * std::exp(-1.25 * std::pow(f, -4.0)) *
         std::pow(peak_enhancement, std::exp(-0.5 * off * off));
}

}  // namespace

std::vector<WaveComponent> wave_components(const WaveKeys& waves, double gravity, double depth) {
  const bool is_focused = waves.waves == WaveKind::focused;
  const auto seed = static_cast<std::uint64_t>(waves.seed);
  const double width = (highest_frequency - lowest_frequency) / components;
  double sum = 0.0;
  std::vector<double> amplitudes;
  std::vector<double> frequencies;
  for (int n = 0; n < components; ++n) {
    // Anywhere in its own bin, so that the waves do not repeat themselves.
    const double f = lowest_frequency + width * (n + 0.5 + 0.5 * random_number(seed, static_cast<std::uint64_t>(n), 0));
    frequencies.push_back(f);
    const double density = jonswap(f, waves.peak_enhancement);
    amplitudes.push_back(is_focused ? density : std::sqrt(2.0 * density * width));
    sum += is_focused ? density : 0.5 * amplitudes.back() * amplitudes.back();
  }
  // H_m0 = 4 sqrt(m_0), or the sum of all amplitudes.
  const double factor = is_focused ? 0.5 * waves.height / sum : 0.25 * waves.height / std::sqrt(sum);
  std::vector<WaveComponent> found;
  for (int n = 0; n < components; ++n) {
    const double omega = 2.0 * std::numbers::pi * frequencies[n] / waves.period;
    const double phase = is_focused ? wave_number(omega, gravity, depth) * waves.focus[0] - omega * waves.focus[1]
                                    : std::numbers::pi * random_number(seed, static_cast<std::uint64_t>(n), 1);
    found.push_back({omega, factor * amplitudes[n], phase});
  }
  return found;
}

double ramp_at(double since, double ramp) {
  return since >= ramp ? 1.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * since / ramp));
}

}  // namespace tailwater
