#include "motion/wave_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/finding.h"
#include "motion/wave_components.h"
#include "motion/wave_theory.h"

namespace tailwater {

WaveField::WaveField(const WaveKeys& waves, const CaseLabel& owner, double depth, double gravity, double transport)
    : start_(waves.start), ramp_(waves.ramp), depth_(depth), current_(transport) {
  if (waves.waves == WaveKind::regular) {
    const std::optional<RegularWave> wave = RegularWave::solve({waves.height, waves.period, depth, gravity, transport});
    if (!wave) {
      throw CaseError({"{} of {:.4g} is too much for the period of {:.4g} s in water {:.4g} m deep: such waves break",
                       owner.with_key("height"), Amount{waves.height, "m"}, waves.period, depth},
                      {"give a smaller height, or a longer period"});
    }
    waves_ = *wave;
    return;
  }
  std::vector<Sine> sines;
  for (const WaveComponent& part : wave_components(waves, gravity, depth)) {
    const double k = wave_number(part.omega, gravity, depth);
    sines.push_back({part.omega, k, part.amplitude, part.phase, part.amplitude * part.omega / std::tanh(k * depth)});
    // Crests carry a^2 omega/(2 tanh kh) more water than troughs carry back. A group passes only once.
    if (waves.waves == WaveKind::jonswap) current_ -= 0.5 * sines.back().speed * part.amplitude / depth;
  }
  waves_ = std::move(sines);
}

double WaveField::growth(double time) const { return time <= start_ ? 0.0 : ramp_at(time - start_, ramp_); }

Eigen::Vector2d WaveField::velocity(double distance, double height, double time) const {
  const double since = time - start_;
  if (const auto* wave = std::get_if<RegularWave>(&waves_)) {
    return growth(time) * wave->velocity(wave->wave_number() * (distance - wave->celerity() * since), height);
  }
  const double z = std::min(height, depth_);
  Eigen::Vector2d sum(current_, 0.0);
  for (const Sine& sine : std::get<std::vector<Sine>>(waves_)) {
    const DepthShape shape(sine.wave_number, z, depth_);
    const double angle = sine.omega * since - sine.wave_number * distance + sine.phase;
    sum += sine.speed * Eigen::Vector2d(shape.cosh * std::cos(angle), -shape.sinh * std::sin(angle));
  }
  return growth(time) * sum;
}

double WaveField::elevation(double distance, double time) const {
  const double since = time - start_;
  if (const auto* wave = std::get_if<RegularWave>(&waves_)) {
    return growth(time) * wave->elevation(wave->wave_number() * (distance - wave->celerity() * since));
  }
  double sum = 0.0;
  for (const Sine& sine : std::get<std::vector<Sine>>(waves_)) {
    sum += sine.amplitude * std::cos(sine.omega * since - sine.wave_number * distance + sine.phase);
  }
  return growth(time) * sum;
}

}  // namespace tailwater
