// The conditions at open ends in a step, from the flow before them and from the prescribed levels and discharges.
#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "flow/flow.h"
#include "flow/pores.h"
#include "motion/wave_theory.h"
#include "open_ends/fibres.h"
#include "open_ends/open_ends.h"

namespace tailwater {
namespace {

/// [dx]; shallower water gives no reliable level.
constexpr double min_depth_over_spacing = 0.1;
/// Time over which the invariant is averaged where the channel goes on, in travel times of a long wave from the gauge
/// into the buffer. It is long compared with the waves that must leave, because waves that the mean follows are
/// reflected (docs/theory/open_ends.md).
constexpr double memory = 100.0;
/// Averaging time where a level is prescribed and lets all waves out, in passes of a long wave through the case; one
/// pass where the level is held. The part of a wave that the mean follows is reflected.
constexpr double passes_of_waves = 8.0;
/// k h of the shortest waves that an absorbing end follows; shorter ones count as such.
constexpr double shortest_wave = 3.0;
/// (k h)^2 below which a wave is long, and the square of a Froude number below which there is none.
constexpr double longest_wave = 1e-6;
constexpr double min_swing = 1e-12;
/// Fraction of the depth by which the level may follow a wave.
constexpr double max_absorbed = 0.5;
/// Averaging time of the error of a prescribed level, in depths that a long wave travels. A level that is off by more
/// than dx for this many averaging times is reported.
constexpr double depths_of_watch = 5.0;
constexpr double windows_until_told = 2.0;
/// [dx]; of the depth that follows from a rating curve.
constexpr double rating_tolerance = 1e-6;
/// [dx]; the entering lattice gains or loses a row when the depth differs from its rows by more than this. The lowest
/// possible value is 0.5; a larger one prevents a slightly oscillating level from changing the rows repeatedly.
constexpr double max_row_error = 0.75;

/// Sums over the water before the buffer, over all ranks, weighted by a hat function, which sums a lattice exactly at
/// any offset.
struct Reading {
  double volume = 0.0;  ///< m^Dim
  double flux = 0.0;    ///< m^(Dim+1)/s; times the velocity along the opening's normal
  double thrust = 0.0;  ///< N m; times the pressure
  double mass = 0.0;    ///< kg

  Reading& operator+=(const Reading& other) {
    volume += other.volume;
    flux += other.flux;
    thrust += other.thrust;
    mass += other.mass;
    return *this;
  }
};

template <int Dim>
Reading read_gauge(const OpenEnd<Dim>& end, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  Reading gauge = sum_over(particles.owned, Reading{}, [&](std::size_t i) -> Reading {
    const Vec<Dim>& x = particles.position[i];
    const double off = std::abs(end.opening.beyond(x) + end.stretch + end.gauge);
    if (!particles.is_fluid(i) || off >= end.gauge || !end.opening.spans(x)) return {};
    const double volume = (1.0 - off / end.gauge) * particles.volume[i];
    return {volume, volume * filled_fraction(flow.pores, x) * end.opening.normal.dot(particles.velocity[i]),
            volume * particles.pressure[i], volume * flow.density_of(i)};
  });
  flow.setup.ranks.sum_each(gauge.volume, gauge.flux, gauge.thrust, gauge.mass);
  return gauge;
}

/// The water at the gauge.
struct WaterInside {
  double depth = 0.0;      ///< m; by its volume
  double bottom = 0.0;     ///< m; of the rectangle as broad as the water's surface that has its area, above the floor
  double rise = 0.0;       ///< m; above that bottom, by its pressure
  double discharge = 0.0;  ///< m^Dim/s; out
};

/// m above the floor; bottom of the rectangle that is as broad as the water's surface and has the area of the section.
template <int Dim>
double mean_bottom(const OpenEnd<Dim>& end, double depth) {
  const double breadth = end.breadth_at(depth);
  return breadth > 0.0 ? depth - end.area_below(depth) / breadth : 0.0;
}

/// Updates the flow before the buffer in `state`.
template <int Dim>
WaterInside follow_water(const OpenEnd<Dim>& end, const Flow<Dim>& flow, double dt, OpenEndState& state) {
  const Reading reading = read_gauge(end, flow);
  const double area = reading.volume / end.gauge;
  WaterInside water{.depth = end.depth_of_area(area)};
  state.surface = water.depth;
  const double breadth = std::max(end.breadth_at(water.depth), end.spacing);
  const bool was_wet = state.is_wet;
  state.is_wet = area > min_depth_over_spacing * end.spacing * breadth;
  if (!state.is_wet) {
    state.acceleration = 0.0;
    return {};
  }
  water.bottom = mean_bottom(end, water.depth);
  const double speed = reading.flux / reading.volume;
  const double discharge = reading.flux / end.gauge;
  water.discharge = discharge;
  // rho g h^2/2 is the force of the flow; before the first step there is no pressure yet.
  const double density = flow.setup.liquids.are_several() ? reading.mass / reading.volume : flow.setup.liquid.density;
  const double thrust = std::max(0.0, reading.thrust) / (density * end.gauge * breadth);
  const double celerity_squared = thrust > 0.0 ? std::sqrt(2.0 * end.gravity * thrust) : end.gravity * area / breadth;
  const double celerity = std::sqrt(celerity_squared);
  if (end.gravity > 0.0) water.rise = celerity_squared / end.gravity;
  const double invariant = speed - 2.0 * celerity;
  state.speed = speed;
  if (!was_wet) {
    state.wet_time = 0.0;
    state.invariant = invariant;
    state.delayed_speed = speed;
    state.acceleration = 0.0;
    state.mean_speed = speed;
    state.mean_discharge = discharge;
  } else if (celerity > 0.0) {
    const double crossing = end.distance() / celerity;
    state.wet_time += dt;
    state.delayed_speed += (1.0 - std::exp(-dt / crossing)) * (speed - state.delayed_speed);
    state.acceleration = (speed - state.delayed_speed) / crossing;
    const double passes = 1.0 + (passes_of_waves - 1.0) * end.flow.absorbing * end.flow.absorbing;
    const double window = end.holds_level() ? std::max(crossing, passes * end.reach / celerity)
                                            : std::clamp(state.wet_time, crossing, memory * crossing);
    const double share = 1.0 - std::exp(-dt / window);
    state.mean_speed += share * (speed - state.mean_speed);
    const double swing = state.delayed_speed - state.mean_speed;
    state.wave.swing += share * (swing * swing - state.wave.swing);
    state.wave.swing_rate += share * (state.acceleration * state.acceleration - state.wave.swing_rate);
    state.mean_discharge += share * (discharge - state.mean_discharge);
    const double rate = 1.0 / window + std::max(0.0, speed - celerity) / end.gauge;
    state.invariant += (1.0 - std::exp(-rate * dt)) * (invariant - state.invariant);
  }
  return water;
}

/// Whether there is a porous layer at a height [m] above the floor before the buffer, in the middle of the opening.
template <int Dim>
bool is_in_layer(const OpenEnd<Dim>& end, const Flow<Dim>& flow, double height) {
  if (flow.pores == nullptr) return false;
  const SectionColumn& middle = end.columns[end.columns.size() / 2];
  const Vec<Dim> in_opening = end.low + height * end.rise + middle.aside * end.aside;
  return filled_fraction(flow.pores, Vec<Dim>(in_opening - (end.stretch + end.gauge) * end.opening.normal)) < 1.0;
}

/// Records the error of the water level before an end, relative to a level `head` [m] above the floor. Inflow has the
/// energy of this level. Water that falls over a brink, with critical flow above the level, is not affected by it. In a
/// layer the surface slopes, and water leaves it through a seepage face above the level.
template <int Dim>
void watch_level(const OpenEnd<Dim>& end, const Flow<Dim>& flow, double head, double depth, double dt,
                 OpenEndState& state) {
  if (is_in_layer(end, flow, head)) return;
  const double fastest = std::sqrt(2.0 / 3.0 * end.gravity * std::max(0.0, head));
  const double in = std::clamp(-state.mean_speed, 0.0, fastest);
  const double error = depth - std::min(head - in * in / (2.0 * end.gravity), end.height);
  const double discharge = state.speed * depth;
  const bool is_felt = error < 0.0 || discharge < 0.0 || discharge * discharge < end.gravity * std::pow(head, 3);
  const double spacing = end.spacing;
  const double window = depths_of_watch * std::sqrt(std::max(head, spacing) / end.gravity);
  LevelError& miss = state.miss;
  miss.mean += (1.0 - std::exp(-dt / window)) * ((is_felt ? error : 0.0) - miss.mean);
  miss.lasts = std::abs(miss.mean) > spacing ? miss.lasts + dt : 0.0;
  if (miss.lasts < windows_until_told * window) return;
  const bool is_new = miss.lasts - dt < windows_until_told * window;
  if (miss.since < 0.0) miss.since = std::max(0.0, flow.state.time - miss.lasts);
  miss.total += is_new ? miss.lasts : dt;
  if (std::abs(miss.mean) > std::abs(miss.most)) miss.most = miss.mean;
}

/// 1/m; wave number of the waves that leave, by the frequency with which the speed before the buffer varies; 0: long
/// ones.
double number_of(const LeavingWave& wave, double gravity, double depth) {
  const bool is_still = wave.swing <= min_swing * gravity * depth;
  if (is_still || wave.swing_rate * depth <= longest_wave * gravity * wave.swing) return 0.0;
  const double omega = std::sqrt(wave.swing_rate / wave.swing);
  return std::min(wave_number(omega, gravity, depth), shortest_wave / depth);
}

/// Updates the wave that leaves: the depth-averaged speed is that of its crests times its height over the depth, and a
/// long wave carries the u - 2 sqrt(g h) of the water beyond. It reaches the buffer later than the gauge.
template <int Dim>
void follow_wave(const OpenEnd<Dim>& end, double depth, OpenEndState& state) {
  const double g = end.gravity;
  LeavingWave& wave = state.wave;
  wave.number = number_of(wave, g, depth);
  const double kh = wave.number * depth;
  const double crests = std::sqrt(g * depth * (kh > 0.0 ? std::tanh(kh) / kh : 1.0));
  const double at_buffer = state.speed - state.acceleration * end.gauge / crests;
  const double change = std::max(at_buffer - state.mean_speed, -2.0 * std::sqrt(g * depth));
  const double height = (g * depth / crests + 0.25 * change) * change / g;
  wave.height = end.flow.absorbing * std::clamp(height, -max_absorbed * depth, max_absorbed * depth);
}

/// The discharge [m^Dim/s] that leaves at the level which a rating curve, a function of this discharge, gives at the
/// same instant. The characteristic u + 2c that arrives at the end gives the speed at a level, and does not depend on
/// the level: the two therefore cannot excite each other. At most the critical discharge; in a full section that of the
/// water inside.
template <int Dim>
double rated_discharge(const OpenEnd<Dim>& end, const WaterInside& water, double time, const OpenEndState& state) {
  if (!state.is_wet) return 0.0;
  const double g = end.gravity;
  const double invariant = state.speed + 2.0 * std::sqrt(g * water.rise);
  const auto celerity = [&](double depth) { return std::sqrt(g * std::max(0.0, depth - water.bottom)); };
  const auto discharge = [&](double depth) {
    return end.area_below(depth) * std::max(0.0, invariant - 2.0 * celerity(depth));
  };
  const auto is_too_low = [&](double depth) {
    const bool is_supercritical = invariant > 3.0 * celerity(depth);
    return is_supercritical || !(end.floor + depth >= end.flow.level->at(time, discharge(depth)));
  };
  double low = 0.0;
  double high = end.height;
  if (g == 0.0 || is_too_low(high)) return std::max(0.0, water.discharge);
  while (high - low > rating_tolerance * end.spacing) {
    const double middle = 0.5 * (low + high);
    (is_too_low(middle) ? low : high) = middle;
  }
  return discharge(high);
}

/// The prescribed level [m] at a discharge [m^Dim/s] that leaves. An end that absorbs waves follows the mean discharge,
/// as far as it absorbs them.
template <int Dim>
double level_at(const OpenEnd<Dim>& end, double time, double discharge, const OpenEndState& state) {
  const double level = end.flow.level->at(time, std::max(0.0, discharge));
  return level + end.flow.absorbing * (end.flow.level->at(time, std::max(0.0, state.mean_discharge)) - level);
}

/// Where a level is prescribed: depth and pressure of the buffer, and the inflow if the water enters with a free
/// surface.
template <int Dim>
Inflow hold_level(const OpenEnd<Dim>& end, const Flow<Dim>& flow, const WaterInside& water, double time, double dt,
                  OpenEndState& state) {
  const double g = end.gravity;
  if (g > 0.0) {
    watch_level(end, flow, level_at(end, time, water.discharge, state) - end.floor, water.depth, dt, state);
  }
  state.level = level_at(end, time, rated_discharge(end, water, time, state), state);
  const double head = state.level - end.floor;
  state.is_full = g == 0.0 || head >= end.height;
  if (state.is_full) {
    state.depth = end.height;
    return {};
  }
  state.wave.height = 0.0;
  if (state.is_wet) follow_wave(end, std::max(head, end.spacing), state);
  state.level += state.wave.height;
  const double surface = std::clamp(state.level - end.floor, 0.0, end.height);
  const double bottom = mean_bottom(end, surface);
  const double invariant = state.is_wet ? -state.speed - 2.0 * std::sqrt(g * water.rise) : 0.0;
  const Inflow inflow = inflow_of_head(g, surface - bottom, invariant);
  state.depth = bottom + inflow.depth;
  return inflow;
}

/// Where the channel goes on: the level that lets a wave out.
template <int Dim>
void go_on(const OpenEnd<Dim>& end, const WaterInside& water, OpenEndState& state) {
  const double twice_celerity = std::max(0.0, state.speed - state.invariant);
  state.depth =
      state.is_wet && end.gravity > 0.0 ? water.bottom + 0.25 * twice_celerity * twice_celerity / end.gravity : 0.0;
}

/// The addition to the discharge of a pump [m^Dim/s] that makes the drawn volume right on average: the rows of
/// particles do not fill an opening of a few spacings exactly. It makes up for the missing volume while the water moves
/// by ten spacings, and is limited to a tenth of the discharge.
template <int Dim>
double missing_discharge(const OpenEnd<Dim>& end, const OpenEndState& state, double discharge, double area) {
  constexpr double spacings_to_catch_up = 10.0;
  constexpr double max_fraction = 0.1;
  if (discharge >= 0.0) return 0.0;
  const double fraction = state.missing() / (spacings_to_catch_up * end.spacing * area);
  return std::clamp(fraction, -max_fraction, max_fraction) * std::abs(discharge);
}

/// Where a discharge or a velocity is prescribed: the depth follows the water inside, unless it is prescribed too.
template <int Dim>
void hold_inflow(const OpenEnd<Dim>& end, const Flow<Dim>& flow, double time, double dt, OpenEndState& state) {
  const double before = state.depth;
  double depth = end.height;  // without gravity along it, or under a lid, the opening is full
  if (end.flow.level) {
    depth = end.depth_at_level(end.flow.level->at(time));
  } else if (end.gravity > 0.0) {
    const double critical = end.critical_depth(time);
    depth = std::max(end.depth_of_area(read_gauge(end, flow).volume / end.gauge), critical);
    if (critical > 0.0) depth = std::max(depth, end.spacing);
    depth = std::min(depth, end.height);
    if (before > 0.0) {
      const double travelled = dt * std::sqrt(end.gravity * before);
      depth = before + (1.0 - std::exp(-travelled / end.distance())) * (depth - before);
    }
  }
  state.depth = depth;
  state.depth_rate = before > 0.0 && dt > 0.0 ? (depth - before) / dt : 0.0;
  const double discharge = end.discharge(time, depth);
  const double area = end.area_below(depth);
  state.entry_speed = area > 0.0 ? (discharge + missing_discharge(end, state, discharge, area)) / area : 0.0;
  if (before > 0.0) state.filling += end.stretch * (area - end.area_below(before));
  state.asked += dt * discharge;
  state.asked_total += dt * std::abs(discharge);
}

/// Rows of the lattice on which particles enter.
template <int Dim>
void choose_rows(const OpenEnd<Dim>& end, OpenEndState& state) {
  state.rows.resize(end.columns.size(), 0);
  for (std::size_t c = 0; c < end.columns.size(); ++c) {
    const double wanted = end.depth_in(c, state) / end.spacing;
    const bool fit = state.rows[c] > 0 && std::abs(wanted - static_cast<double>(state.rows[c])) <= max_row_error;
    if (!fit) state.rows[c] = std::lround(wanted);
  }
}

}  // namespace

template <int Dim>
void OpenEnds<Dim>::begin_step(Flow<Dim>& flow, double dt) {
  driven_change_ = -kinetic_energy_in_driven_ends(flow);
  const double time = flow.state.time + 0.5 * dt;
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    const OpenEnd<Dim>& end = ends_[e];
    OpenEndState& state = states_[e];
    if (end.flow.feeds()) {
      hold_inflow(end, flow, time, dt, state);
    } else {
      const WaterInside water = follow_water(end, flow, dt, state);
      inflows_[e] = {};
      if (end.holds_level()) {
        inflows_[e] = hold_level(end, flow, water, time, dt, state);
      } else {
        go_on(end, water, state);
      }
      find_fibres(end, flow, inflows_[e], state);
    }
    if (end.is_driven()) choose_rows(end, state);
    set_velocities(flow, e);
  }
  driven_change_ += kinetic_energy_in_driven_ends(flow);
}

/// A buffer that moves with the water inside has the velocity of that water at the end of the step. With the velocity
/// before the step, the buffer would be a step late, and accelerated flow would leave a gap or a pile in front of it.
template <int Dim>
void OpenEnds<Dim>::correct(Flow<Dim>& flow, double /*dt*/) {
  driven_change_ -= kinetic_energy_in_driven_ends(flow);
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    if (ends_[e].flow.feeds()) continue;
    find_fibres(ends_[e], flow, inflows_[e], states_[e]);
    set_velocities(flow, e);
  }
  driven_change_ += kinetic_energy_in_driven_ends(flow);
}

template <int Dim>
void OpenEnds<Dim>::set_velocities(Flow<Dim>& flow, std::size_t e) const {
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (end_of_[i] != static_cast<std::int16_t>(e)) return;
    const Vec<Dim>& x = particles.position[i];
    particles.velocity[i] = ends_[e].velocity_at(states_[e], x) / filled_fraction(flow.pores, x);
  });
}

template <int Dim>
double OpenEnds<Dim>::kinetic_energy_in_driven_ends(const Flow<Dim>& flow) const {
  const std::vector<std::size_t> driven =
      indices_where(flow.state.particles.owned, [&](std::size_t i) { return is_driven(i); });
  return sum_over(driven.size(), 0.0, [&](std::size_t n) { return flow.kinetic_energy_of(driven[n]); });
}

template void OpenEnds<2>::begin_step(Flow<2>&, double);
template void OpenEnds<3>::begin_step(Flow<3>&, double);
template void OpenEnds<2>::correct(Flow<2>&, double);
template void OpenEnds<3>::correct(Flow<3>&, double);

}  // namespace tailwater
