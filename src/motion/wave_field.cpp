#include "motion/wave_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/finding.h"
#include "base/random.h"
#include "motion/wave_components.h"
#include "motion/wave_theory.h"

namespace tailwater {

namespace {

/// Largest angle from the mean direction, and from the axis, and steps of the distribution over directions.
constexpr double widest_angle = 75.0 * std::numbers::pi / 180.0;
constexpr int angle_steps = 300;

/// The angle from the mean direction below which the fraction `below` of the energy lies: M.S. Longuet-Higgins et al.
/// (1963).
double spread_angle(double spreading, double below) {
  const double width = 2.0 * widest_angle / angle_steps;
  std::vector<double> sums{0.0};
  for (int n = 0; n < angle_steps; ++n) {
    const double angle = -widest_angle + (n + 0.5) * width;
    sums.push_back(sums.back() + std::pow(std::cos(0.5 * angle), 2.0 * spreading));
  }
  const double wanted = below * sums.back();
  const auto above = std::ranges::upper_bound(sums, wanted);
  const auto n = std::min<std::ptrdiff_t>(above - sums.begin(), angle_steps) - 1;
  return -widest_angle + width * (static_cast<double>(n) + (wanted - sums[n]) / (sums[n + 1] - sums[n]));
}

}  // namespace

WaveField::Direction WaveField::direction_of(double angle, double wave_number, double period_across) {
  double sine = std::sin(std::clamp(angle, -widest_angle, widest_angle));
  if (period_across > 0.0) {
    const double one_wave = 2.0 * std::numbers::pi / (wave_number * period_across);
    sine = one_wave * std::round(sine / one_wave);
    if (std::abs(sine) > std::sin(widest_angle)) sine -= std::copysign(one_wave, sine);
  }
  return {std::sqrt(1.0 - sine * sine), sine};
}

WaveField::WaveField(const WaveKeys& waves, const CaseLabel& owner, double depth, double gravity, double transport,
                     const WaveDirections& directions)
    : start_(waves.start), ramp_(waves.ramp), depth_(depth) {
  if (waves.waves == WaveKind::regular) {
    const std::optional<RegularWave> wave = RegularWave::solve({waves.height, waves.period, depth, gravity, transport});
    if (!wave) {
      throw CaseError("zone-waves-break",
                      {"{} of {:.4g} is too much for the period of {:.4g} s in water {:.4g} m deep: such waves break",
                       owner.with_key("height"), Amount{waves.height, "m"}, waves.period, depth},
                      {"give a smaller height, or a longer period"});
    }
    direction_ = direction_of(directions.mean, wave->wave_number(), directions.period_across);
    waves_ = *wave;
    return;
  }
  current_ = transport * Vec<3>(std::cos(directions.mean), 0.0, std::sin(directions.mean));
  std::vector<Sine> sines;
  const auto seed = static_cast<std::uint64_t>(waves.seed);
  for (const WaveComponent& part : wave_components(waves, gravity, depth)) {
    const double k = wave_number(part.omega, gravity, depth);
    double angle = directions.mean;
    if (directions.spreading > 0.0) {
      angle += spread_angle(directions.spreading, 0.5 + 0.5 * random_number(seed, sines.size(), 2));
    }
    const Direction direction = direction_of(angle, k, directions.period_across);
    sines.push_back(
        {part.omega, k, part.amplitude, part.phase, part.amplitude * part.omega / std::tanh(k * depth), direction});
    // Crests carry a^2 omega/(2 tanh kh) more water than troughs carry back. A group passes only once.
    if (waves.waves == WaveKind::jonswap) {
      current_ -= 0.5 * sines.back().speed * part.amplitude / depth * Vec<3>(direction.along, 0.0, direction.across);
    }
  }
  const auto has_other_direction = [&](const Sine& sine) {
    return sine.direction.across != sines.front().direction.across;
  };
  if (std::ranges::none_of(sines, has_other_direction)) {
    std::vector<TravellingWave> travelling;
    for (const Sine& sine : sines) travelling.push_back({sine.omega, sine.wave_number, sine.amplitude});
    bound_.emplace(travelling, gravity, depth);
    direction_ = sines.front().direction;
  }
  waves_ = std::move(sines);
}

double WaveField::growth(double time) const { return time <= start_ ? 0.0 : ramp_at(time - start_, ramp_); }

Vec<3> WaveField::velocity(double distance, double height, double time, double across) const {
  const double since = time - start_;
  if (const auto* wave = std::get_if<RegularWave>(&waves_)) {
    const double phase = wave->wave_number() * (direction_.way(distance, across) - wave->celerity() * since);
    const auto u = wave->velocity(phase, height);
    return growth(time) * Vec<3>(direction_.along * u[0], u[1], direction_.across * u[0]);
  }
  const double z = std::min(height, depth_);
  Vec<3> sum = current_;
  std::optional<BoundFlow> bound;
  if (bound_) bound.emplace(*bound_, z);
  for (const Sine& sine : std::get<std::vector<Sine>>(waves_)) {
    const DepthShape shape(sine.wave_number, z, depth_);
    const Direction& direction = sine.direction;
    const double angle = sine.omega * since - sine.wave_number * direction.way(distance, across) + sine.phase;
    const double cosine = std::cos(angle);
    const double sine_of_angle = std::sin(angle);
    const double u = shape.cosh * cosine;
    sum += sine.speed * Vec<3>(direction.along * u, -shape.sinh * sine_of_angle, direction.across * u);
    if (bound) bound->add(cosine, sine_of_angle, shape);
  }
  const double grown = growth(time);
  if (!bound) return grown * sum;
  const auto [along, upward] = bound->velocity();
  return grown * (sum + grown * Vec<3>(direction_.along * along, upward, direction_.across * along));
}

double WaveField::elevation(double distance, double time, double across) const {
  const double since = time - start_;
  if (const auto* wave = std::get_if<RegularWave>(&waves_)) {
    const double way = direction_.way(distance, across);
    return growth(time) * wave->elevation(wave->wave_number() * (way - wave->celerity() * since));
  }
  double sum = 0.0;
  for (const Sine& sine : std::get<std::vector<Sine>>(waves_)) {
    const double way = sine.direction.way(distance, across);
    sum += sine.amplitude * std::cos(sine.omega * since - sine.wave_number * way + sine.phase);
  }
  return growth(time) * sum;
}

}  // namespace tailwater
