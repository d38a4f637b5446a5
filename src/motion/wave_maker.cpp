#include "motion/wave_maker.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "geometry/from_spec.h"
#include "motion/wave_components.h"
#include "motion/wave_theory.h"

namespace tailwater {
namespace {

/// A solitary wave begins where its elevation is 0.2 % of its height: sech^2 of this phase. An N-wave begins at 0.05 %.
constexpr double first_phase_of_solitary_wave = -3.8;
constexpr double first_phase_of_n_wave = -5.0;

/// Elevation of an N-wave over its height and sech^2 tanh, whose largest value is 2/(3 sqrt 3).
constexpr double n_wave_factor = 1.5 * std::numbers::sqrt3;

/// Number of periods in which an absorbing plate drifts back to its mean position. Many, so that the drift hardly
/// changes the waves.
constexpr double periods_remembered = 20.0;

/// [dx]; distance of an absorbing plate's gauge from the plate. The gauge extends half as far to each side.
constexpr double gauge_distance = 2.0;

/// kh; in deeper water, second-order waves are negligible, and their hyperbolic functions would overflow.
constexpr double deepest_second_order = 20.0;

/// [1/period]; lower differences of frequencies are left out, because they need strokes that grow like 1/frequency.
constexpr double lowest_difference = 0.05;

double sech_squared(double x) {
  const double cosh_x = std::cosh(std::min(std::abs(x), 300.0));
  return 1.0 / (cosh_x * cosh_x);
}

double gain_of(const WaveMakerTable& maker, double gravity) {
  if (maker.period > 0.0) {
    const double omega = 2.0 * std::numbers::pi / maker.period;
    return omega / maker_transfer(maker.type, omega, gravity, maker.depth).wave;
  }
  // Long waves: omega = k sqrt(g h). The wave is k h times the stroke of a piston, and half of that for a flap.
  return (maker.type == MakerType::flap ? 2.0 : 1.0) * std::sqrt(gravity / maker.depth);
}

}  // namespace

LongWave::LongWave(WaveKind kind, double height, double depth, double gravity)
    : is_solitary_(kind == WaveKind::solitary),
      height_(height),
      depth_(depth),
      celerity_(std::sqrt(gravity * (is_solitary_ ? depth + height : depth))),
      beta_(is_solitary_ ? std::sqrt(0.75 * height / (depth * depth * (depth + height)))
                         : 1.5 / depth * std::sqrt(0.5 * std::numbers::sqrt3 * height / depth)),
      first_phase_(is_solitary_ ? first_phase_of_solitary_wave : first_phase_of_n_wave) {}

// The integral of the elevation over the phase, over beta h.
double LongWave::displacement(double phase) const {
  const double scale = height_ / (beta_ * depth_);
  return is_solitary_ ? scale * std::tanh(phase) : -0.5 * scale * n_wave_factor * sech_squared(phase);
}

double LongWave::elevation_at(double phase) const {
  const double bell = height_ * sech_squared(phase);
  return is_solitary_ ? bell : bell * n_wave_factor * std::tanh(phase);
}

// The plate moves with the water, dX/dt = c eta/(h + eta). With theta = beta (c t - X) this becomes dX/dtheta =
// eta/(beta h), and so c t = theta/beta + X(theta).
double LongWave::phase(double since) const {
  const double distance = celerity_ * since + first_phase_ / beta_ + displacement(first_phase_);
  double theta = beta_ * distance;
  // The slope is (1 + eta/h)/beta, so every step of Newton's method reduces the error.
  for (int step = 0; step < 200; ++step) {
    const double change =
        (distance - theta / beta_ - displacement(theta)) / ((1.0 + elevation_at(theta) / depth_) / beta_);
    theta += change;
    if (std::abs(change) <= 1e-14 * std::max(1.0, std::abs(theta))) break;
  }
  return theta;
}

double LongWave::stroke(double since) const { return displacement(phase(since)) - displacement(first_phase_); }

double LongWave::elevation(double since, double ahead) const { return elevation_at(phase(since) - beta_ * ahead); }

PeriodicWaves::PeriodicWaves(const WaveMakerTable& maker, double gravity, double gauge) : ramp_(maker.ramp) {
  const double h = maker.depth;
  const auto add_sine = [&](double omega, double amplitude, double phase) {
    const MakerTransfer transfer = maker_transfer(maker.type, omega, gravity, h);
    sines_.push_back({omega, wave_number(omega, gravity, h), phase, amplitude / transfer.wave, amplitude,
                      transfer.near_field_at(gauge)});
  };
  if (maker.waves == WaveKind::regular) {
    add_sine(2.0 * std::numbers::pi / maker.period, 0.5 * maker.height, 0.0);
  } else {
    for (const WaveComponent& part : wave_components(maker, gravity, h)) {
      add_sine(part.omega, part.amplitude, part.phase);
    }
  }
  add_second_order(maker, gravity);
}

void PeriodicWaves::add_second_order(const WaveMakerTable& maker, double gravity) {
  std::vector<PlateMotion> motions;
  for (const Sine& sine : sines_) {
    if (sine.wave_number * maker.depth > deepest_second_order) continue;
    // X sin(omega t + phase) is the real part of -i X exp(i omega t + i phase).
    motions.push_back({sine.omega, std::polar(sine.stroke, sine.phase - 0.5 * std::numbers::pi)});
  }
  if (maker.waves != WaveKind::regular) {
    const double slowest = lowest_difference * 2.0 * std::numbers::pi / maker.period;
    second_order_ = second_order_waves(maker.type, motions, slowest, gravity, maker.depth);
  } else if (!motions.empty()) {
    second_order_ = {second_harmonic(maker.type, motions.front(), gravity, maker.depth)};
  }
}

double PeriodicWaves::stroke(double since) const {
  double sum = 0.0;
  for (const Sine& sine : sines_) sum += sine.stroke * std::sin(sine.omega * since + sine.phase);
  for (const SecondOrderWave& wave : second_order_) sum += (wave.stroke * std::polar(1.0, wave.omega * since)).real();
  return ramp_at(since, ramp_) * sum;
}

double PeriodicWaves::elevation(double since, double ahead) const {
  const double x = ahead + stroke(since);
  double sum = 0.0;
  for (const Sine& sine : sines_) {
    const double angle = sine.omega * since + sine.phase;
    sum += sine.elevation * std::cos(angle - sine.wave_number * x) + sine.near_field * sine.stroke * std::sin(angle);
  }
  for (const SecondOrderWave& wave : second_order_) {
    sum += (wave.elevation * std::polar(1.0, wave.omega * since - wave.wave_number * x)).real();
  }
  return ramp_at(since, ramp_) * sum;
}

MakerLaw::MakerLaw(const WaveMakerTable& maker, double gravity, double gauge)
    : start_(maker.start),
      gauge_(gauge),
      gain_(gain_of(maker, gravity)),
      forgetting_(maker.period > 0.0 ? 1.0 / (periods_remembered * maker.period) : 0.0) {
  if (maker.waves == WaveKind::solitary || maker.waves == WaveKind::n_wave) {
    waves_.emplace<LongWave>(maker.waves, maker.height, maker.depth, gravity);
  } else if (maker.waves != WaveKind::none) {
    waves_.emplace<PeriodicWaves>(maker, gravity, gauge);
  }
}

double MakerLaw::stroke(double time) const {
  const double since = time - start_;
  if (since <= 0.0) return 0.0;
  if (const auto* wave = std::get_if<LongWave>(&waves_)) return wave->stroke(since);
  if (const auto* waves = std::get_if<PeriodicWaves>(&waves_)) return waves->stroke(since);
  return 0.0;
}

double MakerLaw::elevation(double time) const {
  const double since = time - start_;
  if (since <= 0.0) return 0.0;
  if (const auto* wave = std::get_if<LongWave>(&waves_)) return wave->elevation(since, gauge_);
  if (const auto* waves = std::get_if<PeriodicWaves>(&waves_)) return waves->elevation(since, gauge_);
  return 0.0;
}

template <int Dim>
WavePlate<Dim>::WavePlate(const CaseSpec& spec, const WaveMakerTable& maker)
    : forward(Vec<Dim>::Zero()),
      up(Vec<Dim>::Zero()),
      along(Vec<Dim>::Zero()),
      width(1.0),
      depth(maker.depth),
      gauge(gauge_distance * spec.particles.spacing),
      turns(maker.type == MakerType::flap),
      absorbs(maker.absorption == Absorption::active),
      law(maker, gravity_of<Dim>(spec).norm(), gauge) {
  const CaseLabel owner("wave_maker", maker.name);
  const Vec<Dim> from = to_vec<Dim>(maker.from, owner, "from");
  const Vec<Dim> to = to_vec<Dim>(maker.to, owner, "to");
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (gravity.norm() == 0.0) {
    throw CaseError("maker-without-gravity", {"{}: without gravity there are no waves", owner},
                    {"give physics.gravity"});
  }
  up = -gravity.normalized();
  const auto side = static_cast<int>(maker.side);
  forward = (side % 2 == 0 ? 1.0 : -1.0) * Vec<Dim>::Unit(side / 2);
  if (std::abs(forward.dot(up)) > 1e-9) {
    throw CaseError("maker-lies-flat", {"{} lies flat, but a plate that makes waves stands upright", owner},
                    {"give `from` and `to` on an upright {}", Dim == 2 ? "segment" : "rectangle"});
  }
  if (up.dot(to - from) < depth) {
    throw CaseError("maker-below-level",
                    {"{}: its top is {:.4g} above its foot, below the still water's level of {:.4g} m", owner,
                     Amount{up.dot(to - from), "m"}, depth},
                    {"give a higher `to`, the foot as `from`, or correct depth"});
  }
  if (maker.waves == WaveKind::regular) {
    const double highest = breaking_height(2.0 * std::numbers::pi / maker.period, gravity.norm(), depth);
    if (maker.height > highest) {
      throw CaseError("maker-waves-break",
                      {"{} of {:.4g} is too much for its period of {:.4g} s: such waves break at {:.4g} m",
                       owner.with_key("height"), Amount{maker.height, "m"}, maker.period, highest},
                      {"give a smaller height, or a longer period"});
    }
  }
  foot = from;
  if constexpr (Dim == 3) {
    along = up.cross(forward);
    width = std::abs(along.dot(to - from));
    foot += 0.5 * along.dot(to - from) * along;
  }
}

template struct WavePlate<2>;
template struct WavePlate<3>;

}  // namespace tailwater
