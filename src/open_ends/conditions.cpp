// The conditions at open ends in a step, from the flow before them and from what the case prescribes.
#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "flow/flow.h"
#include "open_ends/open_ends.h"

namespace tailwater {
namespace {

/// Water shallower than this share of dx gives no reliable level.
constexpr double least_depth_over_spacing = 0.1;
/// Time over which the invariant is averaged, in travel times of a long wave from the gauge into the end stretch. It is
/// long compared with the waves that must leave, because whatever the mean follows is let back in
/// (docs/theory/open_ends.md).
constexpr double memory = 100.0;
/// Time after which an end stretch with a level moves with the water beside it, in travel times of a long wave from the
/// gauge into it. Until then what the pressure does to it counts: the water beside it may be off by what the density
/// and the shifts do there, and would hold a stretch that follows it at once (docs/theory/open_ends.md).
constexpr double travels_until_following = 10.0;
/// [speed of a long wave]; of the water at the opening against that at the border of an end stretch that becomes deeper
/// or shallower. Levels that step change it so fast.
constexpr double most_stretching = 0.1;
/// Depths that a long wave goes while the error of a prescribed level is averaged, and so many of these times the level
/// may be missed by more than dx before it is told.
constexpr double depths_of_watch = 5.0;
constexpr double windows_until_told = 2.0;
/// [dx]; rows of the entering lattice are one more or one less when they have become that much too high or too low
/// together. Half of it would do; the rest keeps a level that trembles from changing them again and again.
constexpr double most_row_error = 0.75;

/// Sums over water, weighted.
struct Reading {
  double volume = 0.0;  ///< m^Dim
  double flux = 0.0;    ///< m^(Dim+1)/s; times the velocity along the opening's normal
  double push = 0.0;    ///< N m; times the pressure
  double excess = 0.0;  ///< N m; times what the pressure is above that in the end stretch, at the same height

  Reading& operator+=(const Reading& other) {
    volume += other.volume;
    flux += other.flux;
    push += other.push;
    excess += other.excess;
    return *this;
  }
  /// Mean velocity out [m/s], or `other` without water.
  double speed_or(double other) const { return volume > 0.0 ? flux / volume : other; }
};

/// What is read at an open end, over all ranks.
struct Readings {
  Reading gauge;   ///< before the end stretch, by a tent that counts a lattice exactly wherever it stands
  Reading border;  ///< within a spacing or two of the end stretch
  Reading inside;  ///< in the end stretch

  Readings& operator+=(const Readings& other) {
    gauge += other.gauge;
    border += other.border;
    inside += other.inside;
    return *this;
  }
};

template <int Dim>
Readings read_end(const OpenEnd<Dim>& end, const OpenEndState& state, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const double spacing = flow.setup.scale.spacing;
  Readings readings = sum_over(particles.owned, Readings{}, [&](std::size_t i) -> Readings {
    if (!particles.is_fluid(i)) return {};
    const Vec<Dim>& x = particles.position[i];
    const double before = -(end.opening.beyond(x) + end.stretch);
    if (before >= 2.0 * end.gauge || !end.opening.spans(x)) return {};
    const double u = end.opening.normal.dot(particles.velocity[i]);
    const auto of_share = [&](double share) -> Reading {
      const double volume = share * particles.volume[i];
      const Vec<Dim> at_border = x + std::max(0.0, before) * end.opening.normal;
      const double excess = particles.pressure[i] - end.pressure_at(state, at_border, flow.setup.liquid.density);
      return {volume, volume * u, volume * particles.pressure[i], volume * excess};
    };
    if (before < 0.0) return {{}, {}, of_share(1.0)};
    const double off = std::abs(before - end.gauge) / end.gauge;
    const double off_border = std::abs(before - spacing) / spacing;
    return {of_share(1.0 - off), of_share(std::max(0.0, 1.0 - off_border)), {}};
  });
  auto& [gauge, border, inside] = readings;
  flow.setup.ranks.sum_each(gauge.volume, gauge.flux, gauge.push, border.volume, border.flux, border.excess,
                            inside.volume, inside.flux);
  return readings;
}

/// Updates `state` from the flow before the end stretch and returns the change of its speed, m/s.
template <int Dim>
double read_flow(const OpenEnd<Dim>& end, const Flow<Dim>& flow, const Reading& reading, double dt,
                 OpenEndState& state) {
  const double depth = reading.volume / (end.gauge * end.width);
  const bool was_wet = state.is_wet;
  state.is_wet = depth > least_depth_over_spacing * flow.setup.scale.spacing;
  if (!state.is_wet) return 0.0;
  const double speed = reading.flux / reading.volume;
  // rho g h^2/2 is the force of the flow; before the first step there is no pressure yet.
  const double push = std::max(0.0, reading.push) / (flow.setup.liquid.density * end.gauge * end.width);
  const double celerity_squared = push > 0.0 ? std::sqrt(2.0 * end.gravity * push) : end.gravity * depth;
  const double celerity = std::sqrt(celerity_squared);
  const double invariant = speed - 2.0 * celerity;
  const double change = was_wet ? speed - state.speed : 0.0;
  if (!was_wet) {
    state.wet_time = 0.0;
    state.invariant = invariant;
    state.speed_beyond = speed;
    state.mean_speed = speed;
  } else if (celerity > 0.0) {
    const double crossing = end.distance() / celerity;
    state.wet_time += dt;
    const double longest = end.holds_level() ? end.reach / celerity : memory * crossing;
    const double window = std::clamp(state.wet_time, crossing, std::max(crossing, longest));
    const double rate = 1.0 / window + std::max(0.0, speed - celerity) / end.gauge;
    state.invariant += (1.0 - std::exp(-rate * dt)) * (invariant - state.invariant);
    state.mean_speed += (1.0 - std::exp(-dt / window)) * (speed - state.mean_speed);
    state.speed_beyond +=
        (1.0 - std::exp(-dt * (std::abs(speed) + celerity) / end.distance())) * (speed - state.speed_beyond);
  }
  state.speed = speed;
  if (end.holds_level()) state.depth_at_gauge = celerity_squared / end.gravity;
  return change;
}

/// What a level beyond an open end means for the flow through it.
struct LevelBeyond {
  double gravity;  ///< m/s^2
  double head;     ///< m; of the level above the opening's lowest point
  double inwards;  ///< m/s; the mean flow into the case, at most critical

  /// m/s; critical flow out of water at rest, two thirds of the head deep. No more enters.
  double fastest() const { return std::sqrt(2.0 / 3.0 * gravity * head); }
  /// m; with the mean flow: what comes in has the energy of the water at rest beyond.
  double mean_depth() const { return head - inwards * inwards / (2.0 * gravity); }
};

/// Remembers that the water before an end is off the level beyond by an `error` [m].
template <int Dim>
void watch_level(double error, const LevelBeyond& beyond, const Flow<Dim>& flow, double dt, LevelError& miss) {
  const double depth = std::max(beyond.head, flow.setup.scale.spacing);
  const double window = depths_of_watch * std::sqrt(depth / beyond.gravity);
  miss.mean += (1.0 - std::exp(-dt / window)) * (error - miss.mean);
  miss.lasts = std::abs(miss.mean) > flow.setup.scale.spacing ? miss.lasts + dt : 0.0;
  if (miss.lasts < windows_until_told * window) return;
  const bool is_new = miss.lasts - dt < windows_until_told * window;
  if (miss.since < 0.0) miss.since = std::max(0.0, flow.state.time - miss.lasts);
  miss.total += is_new ? miss.lasts : dt;
  if (std::abs(miss.mean) > std::abs(miss.most)) miss.most = miss.mean;
}

/// Speed out [m/s] at the border of an end stretch whose level is prescribed. The difference of pressure between the
/// water beside it and the level drives it; slowly it follows the speed of that water, continued over the spacing
/// between them.
template <int Dim>
double border_speed(const OpenEnd<Dim>& end, const Readings& readings, double density, double dt, OpenEndState& state) {
  const double spacing = 0.5 * end.gauge;
  const double at_border = readings.border.speed_or(state.speed);
  const double celerity = std::sqrt(end.gravity * std::max(state.depth_at_gauge, end.gauge));
  const double rate = celerity / end.distance();
  state.gain += (1.0 - std::exp(-dt * rate)) * (at_border - state.speed - state.gain);
  if (readings.border.volume == 0.0) return at_border + state.gain;
  // The water beside it is read a spacing before the border on the mean, and the stretch begins half a spacing after.
  const double push = readings.border.excess / (density * 1.5 * spacing * readings.border.volume);
  const double driven = state.border_speed + dt * (push - state.border_speed * state.gain / spacing);
  return driven + (1.0 - std::exp(-dt * rate / travels_until_following)) * (at_border + state.gain - driven);
}

/// Where a level is prescribed: the depth of the end stretch goes where that of its pressure is, slowly enough that
/// what it gains or loses along the channel can make up for it.
template <int Dim>
void deepen(const OpenEnd<Dim>& end, double dt, OpenEndState& state) {
  const double celerity = std::sqrt(end.gravity * std::max(state.depth, end.gauge));
  const double most = most_stretching * celerity * state.depth / end.stretch;
  const double wanted = celerity * (state.depth_in_middle - state.depth) / end.distance();
  state.depth_rate = std::clamp(wanted, -most, most);
  state.depth = std::max(state.depth + dt * state.depth_rate, least_depth_over_spacing * 0.5 * end.gauge);
}

/// Where a level is prescribed: depths in the end stretch and at the gauge, and the speed of the stretch. The level
/// holds for the mean flow; waves pass.
template <int Dim>
void hold_level(const OpenEnd<Dim>& end, const Flow<Dim>& flow, const Readings& readings, double time, double dt,
                OpenEndState& state) {
  const bool was_wet = state.is_wet;
  read_flow(end, flow, readings.gauge, dt, state);
  LevelBeyond beyond{end.gravity, end.depth_at_level(end.flow.level->at(time)), 0.0};
  const double fastest = beyond.fastest();
  if (!state.is_wet) {
    beyond.inwards = state.entry_speed = fastest;
    state.border_speed = -fastest;
    state.depth = state.depth_in_middle = state.depth_at_gauge = beyond.mean_depth();
    state.depth_rate = 0.0;
    watch_level(-beyond.mean_depth(), beyond, flow, dt, state.miss);
    return;
  }
  const double own = state.depth_at_gauge;
  beyond.inwards = std::clamp(-state.mean_speed, 0.0, fastest);
  const double invariant = std::max(state.mean_speed, -fastest) - 2.0 * std::sqrt(end.gravity * beyond.mean_depth());
  const auto depth_at = [&](double u) {
    // Water that falls over a brink is critical there, and no level beyond is felt.
    const double least = u > 0.0 ? std::min(own, u * u / end.gravity) : 0.0;
    return std::min(std::max(depth_at_speed(invariant, end.gravity, std::max(u, -fastest)), least), end.height);
  };
  state.depth_at_gauge = depth_at(state.speed);
  state.depth_in_middle = depth_at(state.speed_beyond);
  const double stands = readings.gauge.volume / (end.gauge * end.width);
  if (!was_wet) {
    state.border_speed = readings.border.speed_or(state.speed);
    if (state.depth == 0.0) state.depth = std::min(stands, end.height);
  }
  deepen(end, dt, state);
  state.border_speed = std::max(border_speed(end, readings, flow.setup.liquid.density, dt, state), -fastest);
  state.entry_speed = -state.border_speed + end.stretch * state.depth_rate / state.depth;
  const bool is_felt = state.speed < 0.0 || state.depth_at_gauge <= depth_at_speed(invariant, end.gravity, state.speed);
  watch_level(is_felt ? stands - beyond.mean_depth() : 0.0, beyond, flow, dt, state.miss);
}

/// Velocity of a particle in an end stretch whose level is prescribed; `deviation` is that of its own speed out from
/// the mean there. What comes in has one speed. What goes out keeps the profile that it came with, as long as all goes
/// out: particles that go to and fro on their own would leave one by one while the water rests.
template <int Dim>
Vec<Dim> velocity_at_level(const OpenEnd<Dim>& end, const OpenEndState& state, const Vec<Dim>& x, double deviation) {
  const double rate = state.depth > 0.0 ? state.depth_rate / state.depth : 0.0;
  const double mean = -state.entry_speed - end.opening.beyond(x) * rate;
  const double speed = mean > 0.0 ? mean + std::clamp(deviation, -mean, mean) : mean;
  return speed * end.opening.normal + std::min(end.rise.dot(x - end.low), state.depth) * rate * end.rise;
}

/// Where a discharge or a velocity is prescribed: the depth follows the water inside, unless it is prescribed too.
template <int Dim>
void hold_inflow(const OpenEnd<Dim>& end, const Reading& reading, double time, double dt, double spacing,
                 OpenEndState& state) {
  const double before = state.depth;
  double depth = end.height;  // without gravity along it, or under a lid, the opening is full
  if (end.flow.level) {
    depth = end.depth_at_level(end.flow.level->at(time));
  } else if (end.gravity > 0.0) {
    const double critical = end.critical_depth(time);
    depth = std::max(reading.volume / (end.gauge * end.width), critical);
    if (critical > 0.0) depth = std::max(depth, spacing);
    depth = std::min(depth, end.height);
    if (before > 0.0) {
      const double travelled = dt * std::sqrt(end.gravity * before);
      depth = before + (1.0 - std::exp(-travelled / end.distance())) * (depth - before);
    }
  }
  state.depth = depth;
  state.depth_rate = before > 0.0 && dt > 0.0 ? (depth - before) / dt : 0.0;
  const double q = end.discharge_per_width(time, depth);
  state.entry_speed = depth > 0.0 ? q / depth : 0.0;
  state.asked += dt * q * end.width;
}

/// Rows of the lattice on which particles enter.
void choose_rows(double spacing, OpenEndState& state) {
  const double wanted = state.depth / spacing;
  const bool fit = state.rows > 0 && std::abs(wanted - static_cast<double>(state.rows)) <= most_row_error;
  if (!fit) state.rows = std::lround(wanted);
}

}  // namespace

template <int Dim>
void OpenEnds<Dim>::begin_step(Flow<Dim>& flow, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  driven_change_ = -kinetic_energy_in_driven_ends(flow);
  const double time = flow.state.time + 0.5 * dt;
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    const OpenEnd<Dim>& end = ends_[e];
    OpenEndState& state = states_[e];
    const Readings readings = read_end(end, state, flow);
    double change = 0.0;
    if (end.flow.feeds()) {
      hold_inflow(end, readings.gauge, time, dt, flow.setup.scale.spacing, state);
    } else if (end.holds_level()) {
      hold_level(end, flow, readings, time, dt, state);
    } else {
      change = read_flow(end, flow, readings.gauge, dt, state);
    }
    if (end.is_driven()) choose_rows(flow.setup.scale.spacing, state);
    const Vec<Dim>& normal = end.opening.normal;
    const double mean = readings.inside.speed_or(0.0);
    for_each(particles.owned, [&](std::size_t i) {
      if (end_of_[i] != static_cast<std::int16_t>(e)) return;
      Vec<Dim>& velocity = particles.velocity[i];
      if (end.flow.feeds()) {
        velocity = end.inflow_at(state, particles.position[i]);
      } else if (end.holds_level()) {
        velocity = velocity_at_level(end, state, particles.position[i], normal.dot(velocity) - mean);
      } else {
        velocity = (normal.dot(velocity) + change) * normal;
      }
    });
  }
  driven_change_ += kinetic_energy_in_driven_ends(flow);
}

template <int Dim>
double OpenEnds<Dim>::kinetic_energy_in_driven_ends(const Flow<Dim>& flow) const {
  const std::vector<std::size_t> driven =
      indices_where(flow.state.particles.owned, [&](std::size_t i) { return is_driven(i); });
  return sum_over(driven.size(), 0.0, [&](std::size_t n) { return flow.kinetic_energy_of(driven[n]); });
}

template void OpenEnds<2>::begin_step(Flow<2>&, double);
template void OpenEnds<3>::begin_step(Flow<3>&, double);

}  // namespace tailwater
