#include "flow/open_end.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "flow/verbs.h"

namespace tailwater {
namespace {

/// A smaller share of gravity along the outlet is rounding error.
constexpr double least_gravity_share = 1e-9;
constexpr double gauge_over_spacing = 2.0;
/// Water shallower than this share of dx gives no reliable level.
constexpr double least_depth_over_spacing = 0.1;
/// Time over which the invariant is averaged, in travel times of a long wave from the gauge into the end stretch. It is
/// long compared with the waves that must leave, because whatever the mean follows is let back in
/// (docs/theory/outlets.md).
constexpr double memory = 100.0;

/// Sums over the water before the end stretch, weighted by a tent of half width `gauge`. With a half width of two
/// lattice columns the tent counts a lattice exactly wherever it stands.
struct Reading {
  double volume = 0.0;  ///< m^Dim
  double flux = 0.0;    ///< m^(Dim+1)/s; times the velocity along the outlet's normal
  double push = 0.0;    ///< N m; times the pressure

  Reading& operator+=(const Reading& other) {
    volume += other.volume;
    flux += other.flux;
    push += other.push;
    return *this;
  }
};

template <int Dim>
Reading read_gauge(const OpenEnd<Dim>& end, const Particles<Dim>& particles) {
  return sum_over(particles.owned, Reading{}, [&](std::size_t i) -> Reading {
    if (!particles.is_fluid(i)) return {};
    const Vec<Dim>& x = particles.position[i];
    const double off = std::abs(end.outlet.beyond(x) + end.stretch + end.gauge);
    if (off >= end.gauge || !end.outlet.spans(x)) return {};
    const double share = (1.0 - off / end.gauge) * particles.volume[i];
    return {share, share * end.outlet.normal.dot(particles.velocity[i]), share * particles.pressure[i]};
  });
}

/// Updates `state` from the flow before the end stretch and returns the change of its speed, m/s.
template <int Dim>
double read_flow(const OpenEnd<Dim>& end, const Flow<Dim>& flow, double dt, OpenEndState& state) {
  Reading reading = read_gauge(end, flow.state.particles);
  flow.setup.ranks.sum_each(reading.volume, reading.flux, reading.push);
  const double depth = reading.volume / (end.gauge * end.width);
  const bool was_wet = state.is_wet;
  state.is_wet = depth > least_depth_over_spacing * flow.setup.spacing;
  if (!state.is_wet) return 0.0;
  const double speed = reading.flux / reading.volume;
  // rho g h^2/2 is the force of the flow; before the first step there is no pressure yet.
  const double push = std::max(0.0, reading.push) / (flow.setup.density * end.gauge * end.width);
  const double celerity_squared = push > 0.0 ? std::sqrt(2.0 * end.gravity * push) : end.gravity * depth;
  const double celerity = std::sqrt(celerity_squared);
  const double invariant = speed - 2.0 * celerity;
  const double change = was_wet ? speed - state.speed : 0.0;
  if (!was_wet) {
    state.wet_time = 0.0;
    state.invariant = invariant;
    state.speed_beyond = speed;
  } else if (celerity > 0.0) {
    const double distance = 0.5 * end.stretch + end.gauge;
    const double crossing = distance / celerity;
    state.wet_time += dt;
    const double window = std::clamp(state.wet_time, crossing, memory * crossing);
    const double rate = 1.0 / window + std::max(0.0, speed - celerity) / end.gauge;
    state.invariant += (1.0 - std::exp(-rate * dt)) * (invariant - state.invariant);
    state.speed_beyond +=
        (1.0 - std::exp(-dt * (std::abs(speed) + celerity) / distance)) * (speed - state.speed_beyond);
  }
  state.speed = speed;
  return change;
}

/// Depth [m] of a flow with speed u and the invariant that comes from beyond.
double depth_at_speed(const OpenEndState& state, double gravity, double u) {
  const double twice_celerity = std::max(0.0, u - state.invariant);
  return 0.25 * twice_celerity * twice_celerity / gravity;
}

}  // namespace

Departed& Departed::operator+=(const Departed& other) {
  particles += other.particles;
  volume += other.volume;
  energy += other.energy;
  return *this;
}

template <int Dim>
OpenEnd<Dim>::OpenEnd(const Outlet<Dim>& place, const Vec<Dim>& full_gravity, double spacing, double support)
    : outlet(place), stretch(support + spacing), gauge(gauge_over_spacing * spacing) {
  const Vec<Dim> along = full_gravity - outlet.normal.dot(full_gravity) * outlet.normal;
  gravity = along.norm() > least_gravity_share * full_gravity.norm() ? along.norm() : 0.0;
  up = gravity > 0.0 ? Vec<Dim>(-along / gravity) : Vec<Dim>(Vec<Dim>::Zero());
  floor = up.dot(outlet.corner);
  for (const Vec<Dim>& edge : outlet.edges) floor += std::min(0.0, up.dot(edge));
  width = 1.0;
  if constexpr (Dim == 3) {
    const bool first_is_wide = std::abs(up.dot(outlet.edges[0])) < std::abs(up.dot(outlet.edges[1]));
    width = outlet.edges[first_is_wide ? 0 : 1].norm();
  }
}

template <int Dim>
double OpenEnd<Dim>::pressure_at(const OpenEndState& state, const Vec<Dim>& x, double density) const {
  if (gravity == 0.0 || !state.is_wet) return 0.0;
  const double share = (outlet.beyond(x) + stretch + gauge) / (0.5 * stretch + gauge);
  const double level = floor + (1.0 - share) * depth_at_speed(state, gravity, state.speed) +
                       share * depth_at_speed(state, gravity, state.speed_beyond);
  return density * gravity * std::max(0.0, level - up.dot(x));
}

template <int Dim>
void hold_open_ends(Flow<Dim>& flow, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  flow.end_of.assign(particles.owned, -1);
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const OpenEnd<Dim>& end = flow.setup.open_ends[e];
    const double change = read_flow(end, flow, dt, flow.state.open_ends[e]);
    for_each(particles.owned, [&](std::size_t i) {
      if (!particles.is_fluid(i) || !end.holds(particles.position[i])) return;
      flow.end_of[i] = static_cast<std::int16_t>(e);
      particles.velocity[i] = (end.outlet.normal.dot(particles.velocity[i]) + change) * end.outlet.normal;
    });
  }
}

template <int Dim>
bool let_go(Flow<Dim>& flow) {
  const std::vector<OpenEnd<Dim>>& ends = flow.setup.open_ends;
  if (ends.empty()) return false;
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<std::size_t> passed(particles.owned);  // which end; the number of ends for a particle that stays
  for_each(particles.owned, [&](std::size_t i) {
    const auto end = std::find_if(ends.begin(), ends.end(), [&](const OpenEnd<Dim>& e) {
      return particles.is_fluid(i) && e.outlet.is_passed_by(particles.position[i]);
    });
    passed[i] = static_cast<std::size_t>(end - ends.begin());
  });
  for (std::size_t e = 0; e < ends.size(); ++e) {
    Departed departed = sum_over(particles.owned, Departed{}, [&](std::size_t i) -> Departed {
      if (passed[i] != e) return {};
      return {1, particles.volume[i], flow.kinetic_energy_of(i) + flow.potential_energy_of(i)};
    });
    flow.setup.ranks.sum_each(departed.particles, departed.volume, departed.energy);
    flow.state.open_ends[e].departed += departed;
  }
  const std::vector<std::size_t> kept =
      indices_where(particles.owned, [&](std::size_t i) { return passed[i] == ends.size(); });
  if (kept.size() == particles.owned) return false;
  flow.neighbourhood.keep(flow.state.particles, std::vector<std::int32_t>(kept.begin(), kept.end()));
  return true;
}

#define TAILWATER_INSTANTIATE(Dim)                       \
  template struct OpenEnd<Dim>;                          \
  template void hold_open_ends<Dim>(Flow<Dim>&, double); \
  template bool let_go<Dim>(Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
