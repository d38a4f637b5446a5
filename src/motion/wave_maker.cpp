#include "motion/wave_maker.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "geometry/from_spec.h"
#include "motion/second_order.h"
#include "motion/wave_components.h"
#include "motion/wave_theory.h"

namespace tailwater {
namespace {

/// A solitary wave begins where its elevation is this fraction of its height: sech^2 of this phase, 0.2 %.
constexpr double phase_at_start = -3.8;

/// Number of periods in which an absorbing plate drifts back to its mean position. Many, so that the drift hardly
/// changes the waves.
constexpr double periods_remembered = 20.0;

/// [dx]; distance of an absorbing plate's gauge from the plate. The gauge extends half as far to each side.
constexpr double gauge_distance = 2.0;

/// kh; in deeper water, second-order waves are negligible, and their hyperbolic functions would overflow.
constexpr double deepest_second_order = 20.0;

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

SolitaryWave::SolitaryWave(double height, double depth, double gravity)
    : height_(height),
      depth_(depth),
      celerity_(std::sqrt(gravity * (depth + height))),
      beta_(std::sqrt(0.75 * height / (depth * depth * (depth + height)))) {}

double SolitaryWave::displacement(double phase) const { return height_ / (beta_ * depth_) * std::tanh(phase); }

// The plate moves with the water, dX/dt = c eta/(h + eta). With theta = beta (c t - X) this becomes dX/dtheta = H/(beta
// h) sech^2 theta, and so c t = theta/beta + X(theta).
double SolitaryWave::phase(double since) const {
  const double distance = celerity_ * since + phase_at_start / beta_ + displacement(phase_at_start);
  double theta = beta_ * distance;
  // The slope lies between 1/beta and (1 + H/h)/beta, so every step of Newton's method reduces the error.
  for (int step = 0; step < 200; ++step) {
    const double change =
        (distance - theta / beta_ - displacement(theta)) / ((1.0 + height_ / depth_ * sech_squared(theta)) / beta_);
    theta += change;
    if (std::abs(change) <= 1e-14 * std::max(1.0, std::abs(theta))) break;
  }
  return theta;
}

double SolitaryWave::stroke(double since) const { return displacement(phase(since)) - displacement(phase_at_start); }

double SolitaryWave::elevation(double since, double ahead) const {
  return height_ * sech_squared(phase(since) - beta_ * ahead);
}

PeriodicWaves::PeriodicWaves(const WaveMakerTable& maker, double gravity, double gauge) : ramp_(maker.ramp) {
  const double h = maker.depth;
  const auto sine = [&](double omega, double amplitude, double phase) {
    const MakerTransfer transfer = maker_transfer(maker.type, omega, gravity, h);
    return Sine{omega,     wave_number(omega, gravity, h), phase, amplitude / transfer.wave,
                amplitude, transfer.near_field_at(gauge)};
  };
  if (maker.waves == WaveKind::regular) {
    const double omega = 2.0 * std::numbers::pi / maker.period;
    sines_.push_back(sine(omega, 0.5 * maker.height, 0.0));
    add_second_harmonic(maker, gravity);
    return;
  }
  for (const WaveComponent& part : wave_components(maker, gravity, h)) {
    sines_.push_back(sine(part.omega, part.amplitude, part.phase));
  }
}

void PeriodicWaves::add_second_harmonic(const WaveMakerTable& maker, double gravity) {
  const double h = maker.depth;
  const double omega = sines_.front().omega;
  const double k = sines_.front().wave_number;
  if (k * h > deepest_second_order) return;
  // X sin(omega t) is the real part of -i X exp(i omega t).
  const std::complex<double> stroke =
      second_harmonic_stroke(maker.type, omega, std::complex<double>(0.0, -sines_.front().stroke), gravity, h);
  sines_.push_back({2.0 * omega, 2.0 * k, std::arg(stroke) + 0.5 * std::numbers::pi, std::abs(stroke), 0.0, 0.0});
  const double sinh_y = std::sinh(k * h);
  const double bound = maker.height * maker.height * k / 16.0 * std::cosh(k * h) * (2.0 + std::cosh(2.0 * k * h)) /
                       (sinh_y * sinh_y * sinh_y);
  sines_.push_back({2.0 * omega, 2.0 * k, 0.0, 0.0, bound, 0.0});
}

double PeriodicWaves::stroke(double since) const {
  double sum = 0.0;
  for (const Sine& sine : sines_) sum += sine.stroke * std::sin(sine.omega * since + sine.phase);
  return ramp_at(since, ramp_) * sum;
}

double PeriodicWaves::elevation(double since, double ahead) const {
  const double x = ahead + stroke(since);
  double sum = 0.0;
  for (const Sine& sine : sines_) {
    const double angle = sine.omega * since + sine.phase;
    sum += sine.elevation * std::cos(angle - sine.wave_number * x) + sine.near_field * sine.stroke * std::sin(angle);
  }
  return ramp_at(since, ramp_) * sum;
}

MakerLaw::MakerLaw(const WaveMakerTable& maker, double gravity, double gauge)
    : start_(maker.start),
      gauge_(gauge),
      gain_(gain_of(maker, gravity)),
      forgetting_(maker.period > 0.0 ? 1.0 / (periods_remembered * maker.period) : 0.0) {
  if (maker.waves == WaveKind::solitary) {
    waves_.emplace<SolitaryWave>(maker.height, maker.depth, gravity);
  } else if (maker.waves != WaveKind::none) {
    waves_.emplace<PeriodicWaves>(maker, gravity, gauge);
  }
}

double MakerLaw::stroke(double time) const {
  const double since = time - start_;
  if (since <= 0.0) return 0.0;
  if (const auto* wave = std::get_if<SolitaryWave>(&waves_)) return wave->stroke(since);
  if (const auto* waves = std::get_if<PeriodicWaves>(&waves_)) return waves->stroke(since);
  return 0.0;
}

double MakerLaw::elevation(double time) const {
  const double since = time - start_;
  if (since <= 0.0) return 0.0;
  if (const auto* wave = std::get_if<SolitaryWave>(&waves_)) return wave->elevation(since, gauge_);
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
    throw CaseError({"{}: without gravity there are no waves", owner}, {"give physics.gravity"});
  }
  up = -gravity.normalized();
  const auto side = static_cast<int>(maker.side);
  forward = (side % 2 == 0 ? 1.0 : -1.0) * Vec<Dim>::Unit(side / 2);
  if (std::abs(forward.dot(up)) > 1e-9) {
    throw CaseError({"{} lies flat, but a plate that makes waves stands upright", owner},
                    {"give `from` and `to` on an upright {}", Dim == 2 ? "segment" : "rectangle"});
  }
  if (up.dot(to - from) < depth) {
    throw CaseError({"{}: its top is {:.4g} above its foot, below the still water's level of {:.4g} m", owner,
                     Amount{up.dot(to - from), "m"}, depth},
                    {"give a higher `to`, the foot as `from`, or correct depth"});
  }
  if (maker.waves == WaveKind::regular) {
    const double highest = breaking_height(2.0 * std::numbers::pi / maker.period, gravity.norm(), depth);
    if (maker.height > highest) {
      throw CaseError({"{} of {:.4g} is too much for its period of {:.4g} s: such waves break at {:.4g} m",
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
