#include "motion/wave_zone.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "base/box.h"
#include "geometry/from_spec.h"
#include "motion/wave_theory.h"

namespace tailwater {
namespace {

using Complex = std::complex<double>;
constexpr Complex i_unit(0.0, 1.0);

/// Layers of even rate in an estimate.
constexpr int layers = 200;

/// [omega]; strengths among which the best one is searched.
constexpr double weakest = 0.5;
constexpr double strongest = 16.0;
constexpr int strengths = 41;

/// A zone that makes waves may reflect this much for a higher strength, which also compensates the losses of its waves.
constexpr double allowed_reflection = 0.02;

/// The wave number of waves that lose their velocity at `rate`: omega (omega + i rate) = g k tanh kh, continued from
/// the nearby solution `k`.
Complex damped_wave_number(double omega, double rate, double gravity, double depth, Complex k) {
  const Complex target = omega * Complex(omega, rate) * depth / gravity;
  Complex y = k * depth;
  for (int step = 0; step < 30; ++step) {
    const Complex tanh_y = std::tanh(y);
    const Complex change = (target - y * tanh_y) / (tanh_y + y * (1.0 - tanh_y * tanh_y));
    y += change;
    if (std::abs(change) <= 1e-13 * std::abs(y)) break;
  }
  return y / depth;
}

/// The flux of the mild-slope equation over the gradient of the pressure.
Complex conductance(double omega, double rate, double depth, Complex k) {
  const Complex y = k * depth;
  const Complex tanh_y = std::tanh(y);
  // 2y/sinh 2y without overflow.
  const Complex ratio = y * (1.0 - tanh_y * tanh_y) / tanh_y;
  return tanh_y / (2.0 * k) * (1.0 + ratio) / Complex(rate, -omega);
}

/// None if the case does not have the period or the depth.
std::optional<ZoneWaves> waves_at(const CaseSpec& spec, const DampingTable& zone) {
  std::set<double> periods, depths;
  const auto add = [&](double period, double depth) {
    if (period > 0.0) periods.insert(period);
    if (depth > 0.0) depths.insert(depth);
  };
  for (const WaveMakerTable& maker : spec.wave_makers) {
    if (has_period(maker.waves)) add(maker.period, maker.depth);
  }
  for (const DampingTable& other : spec.damping) {
    if (other.waves != WaveKind::none) add(other.period, other.depth);
  }
  const double period = zone.period > 0.0 ? zone.period : periods.size() == 1 ? *periods.begin() : 0.0;
  const double depth = zone.depth > 0.0 ? zone.depth : depths.size() == 1 ? *depths.begin() : 0.0;
  if (period == 0.0 || depth == 0.0) return std::nullopt;
  return ZoneWaves{2.0 * std::numbers::pi / period, depth};
}

/// The strength [1/s] of a zone: its own, or the best one for its waves.
double strength_of(const DampingTable& zone, const ZoneWaves& waves, double gravity) {
  if (zone.strength > 0.0) return zone.strength;
  return best_strength(waves.omega, gravity, waves.depth, length_of(zone), zone.waves != WaveKind::none);
}

}  // namespace

ZoneEstimate estimate_zone(double omega, double gravity, double depth, double length, double strength) {
  const double k0 = wave_number(omega, gravity, depth);
  const double step = length / layers;
  std::vector<Complex> k, admittance;
  Complex near = k0;
  for (int n = 0; n < layers; ++n) {
    const double fraction = (n + 0.5) / layers;
    const double rate = strength * fraction * fraction;
    near = damped_wave_number(omega, rate, gravity, depth, near);
    k.push_back(near);
    admittance.push_back(near * conductance(omega, rate, depth, near));
  }
  // From the wall, where the pressure is 1 and the flux 0, to the inner end.
  Complex pressure = 1.0;
  Complex flux = 0.0;
  for (int n = layers - 1; n >= 0; --n) {
    const Complex cosine = std::cos(k[n] * step);
    const Complex sine = std::sin(k[n] * step);
    const Complex outer = pressure;
    pressure = outer * cosine - flux * sine / admittance[n];
    flux = flux * cosine + outer * admittance[n] * sine;
  }
  const Complex gradient = flux / (i_unit * k0 * conductance(omega, 0.0, depth, k0));
  const Complex incoming = 0.5 * (pressure + gradient);
  const Complex outgoing = 0.5 * (pressure - gradient);
  // By reciprocity a wall that keeps the flux of a wave of amplitude 1 away sends half of the wall's pressure in an
  // incoming wave of amplitude 1 through the zone.
  return {std::abs(outgoing / incoming), 0.5 / std::abs(incoming)};
}

double best_strength(double omega, double gravity, double depth, double length, bool makes_waves) {
  double best = weakest * omega;
  double least = std::numeric_limits<double>::infinity();
  double strongest_allowed = 0.0;
  for (int n = 0; n < strengths; ++n) {
    const double strength = omega * weakest * std::pow(strongest / weakest, n / (strengths - 1.0));
    const ZoneEstimate estimate = estimate_zone(omega, gravity, depth, length, strength);
    if (makes_waves && estimate.worse() < allowed_reflection) strongest_allowed = strength;
    const double error = makes_waves ? estimate.worse() : estimate.reflection;
    if (error >= least) continue;
    least = error;
    best = strength;
  }
  return std::max(best, strongest_allowed);
}

double length_of(const DampingTable& zone) {
  const auto axis = static_cast<std::size_t>(zone.towards) / 2;
  return zone.max[axis] - zone.min[axis];
}

std::optional<ZoneForecast> forecast_zone(const CaseSpec& spec, const DampingTable& zone, double gravity) {
  const std::optional<ZoneWaves> waves = waves_at(spec, zone);
  if (!waves || gravity == 0.0) return std::nullopt;
  const double strength = strength_of(zone, *waves, gravity);
  return ZoneForecast{*waves, wave_number(waves->omega, gravity, waves->depth), strength,
                      estimate_zone(waves->omega, gravity, waves->depth, length_of(zone), strength)};
}

template <int Dim>
WaveZone<Dim>::WaveZone(const CaseSpec& spec, const DampingTable& table)
    : low_(to_vec<Dim>(table.min, CaseLabel("damping", table.name), "min")),
      high_(to_vec<Dim>(table.max, CaseLabel("damping", table.name), "max")),
      up_(Vec<Dim>::Zero()),
      across_(Vec<Dim>::Zero()),
      axis_(static_cast<int>(table.towards) / 2),
      grows_upwards_(static_cast<int>(table.towards) % 2 == 1),
      strength_(table.strength),
      current_(Vec<Dim>::Zero()) {
  const CaseLabel owner("damping", table.name);
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  const std::optional<ZoneWaves> waves = waves_at(spec, table);
  if (strength_ == 0.0 && (!waves || gravity.norm() == 0.0)) {
    throw CaseError("damping-without-strength",
                    {"{}: without a strength, the zone needs the period and the depth of its waves", owner},
                    {"give strength, or period and depth"});
  }
  if (strength_ == 0.0) strength_ = strength_of(table, *waves, gravity.norm());
  if (table.waves == WaveKind::none) {
    current_[axis_] = (grows_upwards_ ? 1.0 : -1.0) * table.transport;
    return;
  }
  if (gravity.norm() == 0.0 || std::abs(gravity[axis_]) > 1e-9 * gravity.norm()) {
    throw CaseError("damping-along-gravity", {"{}: its waves run along gravity", owner},
                    {"choose a horizontal direction for towards"});
  }
  up_ = -gravity.normalized();
  bed_ = table.level - waves->depth;
  WaveDirections directions{.mean = table.direction * std::numbers::pi / 180.0, .spreading = table.spreading};
  if constexpr (Dim == 3) {
    int upright = 0;
    gravity.cwiseAbs().maxCoeff(&upright);
    const int level_axis = 3 - axis_ - upright;
    across_ = Vec<Dim>::Unit(level_axis);
    const std::vector<double>& periodic = periodic_range(spec.domain, level_axis);
    if (!periodic.empty()) directions.period_across = periodic[1] - periodic[0];
  }
  field_.emplace(table, owner, waves->depth, gravity.norm(), table.transport, directions);
}

template <int Dim>
double WaveZone<Dim>::rate_at(const Vec<Dim>& x) const {
  if (!Box<Dim>(low_, high_).contains(x)) return 0.0;
  const double from_low = (x[axis_] - low_[axis_]) / (high_[axis_] - low_[axis_]);
  const double fraction = grows_upwards_ ? from_low : 1.0 - from_low;
  return strength_ * fraction * fraction;
}

template <int Dim>
Vec<Dim> WaveZone<Dim>::target(const Vec<Dim>& x, double time) const {
  if (!field_) return current_;
  // Waves run from the side `towards` to the opposite one, where their distance is 0.
  const double way = grows_upwards_ ? -1.0 : 1.0;
  const double distance = way * (x[axis_] - (grows_upwards_ ? low_[axis_] : high_[axis_]));
  const Vec<3> u = field_->velocity(distance, x.dot(up_) - bed_, time, x.dot(across_));
  return way * u[0] * Vec<Dim>::Unit(axis_) + u[1] * up_ + u[2] * across_;
}

template class WaveZone<2>;
template class WaveZone<3>;

}  // namespace tailwater
