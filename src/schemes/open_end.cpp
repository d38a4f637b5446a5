#include "schemes/open_end.h"

#include <algorithm>
#include <cmath>

#include "schemes/flow.h"
#include "schemes/verbs.h"

namespace tailwater {
namespace {

constexpr double gauge_over_spacing = 2.0;
/// Water shallower than this share of dx does not tell a level.
constexpr double least_depth_over_spacing = 0.1;
/// Lengths that a long wave runs while the invariant from beyond forgets what it was, over the gauge's distance.
constexpr double memory = 50.0;

/// What a gauge before the end stretch reads.
struct Reading {
  double volume = 0.0;
  double flux = 0.0;
};

template <int Dim>
Reading read_gauge(const OpenEnd<Dim>& end, const Particles<Dim>& particles) {
  Reading reading;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double off = std::abs(end.outlet.beyond(particles.position[i]) + end.stretch + end.gauge);
    if (off >= end.gauge || !end.outlet.spans(particles.position[i])) continue;
    const double share = (1.0 - off / end.gauge) * particles.volume[i];
    reading.volume += share;
    reading.flux += share * end.outlet.normal.dot(particles.velocity[i]);
  }
  return reading;
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
    : outlet(place), stretch(support), gauge(gauge_over_spacing * spacing) {
  const Vec<Dim> along = full_gravity - outlet.normal.dot(full_gravity) * outlet.normal;
  gravity = along.norm();
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
double OpenEnd<Dim>::depth(double u) const {
  const double twice_celerity = std::max(0.0, u - invariant);
  return 0.25 * twice_celerity * twice_celerity / gravity;
}

template <int Dim>
double OpenEnd<Dim>::pressure_at(const Vec<Dim>& x, double density) const {
  if (gravity == 0.0 || !is_wet) return 0.0;
  const double share = (outlet.beyond(x) + stretch + gauge) / (0.5 * stretch + gauge);
  const double level = floor + (1.0 - share) * depth(speed) + share * depth(speed_beyond);
  return density * gravity * std::max(0.0, level - up.dot(x));
}

template <int Dim>
void hold_open_ends(Flow<Dim>& flow, double dt) {
  Particles<Dim>& particles = flow.particles;
  flow.end_of.assign(particles.owned, -1);
  for (std::size_t e = 0; e < flow.open_ends.size(); ++e) {
    OpenEnd<Dim>& end = flow.open_ends[e];
    const Reading reading = read_gauge(end, particles);
    const double depth = reading.volume / (end.gauge * end.width);
    const bool was_wet = end.is_wet;
    end.is_wet = depth > least_depth_over_spacing * flow.spacing;
    double change = 0.0;
    if (end.is_wet) {
      const double speed = reading.flux / reading.volume;
      const double celerity = std::sqrt(end.gravity * depth);
      const double invariant = speed - 2.0 * celerity;
      const double distance = 0.5 * end.stretch + end.gauge;
      if (was_wet) {
        change = speed - end.speed;
        const double rate = std::max(0.0, speed - celerity) / end.gauge + celerity / (memory * distance);
        end.invariant += (1.0 - std::exp(-rate * dt)) * (invariant - end.invariant);
        end.speed_beyond +=
            (1.0 - std::exp(-dt * (std::abs(speed) + celerity) / distance)) * (speed - end.speed_beyond);
      } else {
        end.invariant = invariant;
        end.speed_beyond = speed;
      }
      end.speed = speed;
    }
    for (std::size_t i = 0; i < particles.owned; ++i) {
      if (!particles.is_fluid(i) || !end.holds(particles.position[i])) continue;
      flow.end_of[i] = static_cast<std::int8_t>(e);
      particles.velocity[i] = (end.outlet.normal.dot(particles.velocity[i]) + change) * end.outlet.normal;
    }
  }
}

template <int Dim>
bool let_go(Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.particles;
  std::vector<std::int32_t> kept;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const auto end = std::find_if(flow.open_ends.begin(), flow.open_ends.end(), [&](const OpenEnd<Dim>& e) {
      return particles.is_fluid(i) && e.outlet.is_passed_by(particles.position[i]);
    });
    if (end == flow.open_ends.end()) {
      kept.push_back(static_cast<std::int32_t>(i));
      continue;
    }
    ++end->departed.particles;
    end->departed.volume += particles.volume[i];
    end->departed.energy += flow.kinetic_energy_of(i) + flow.potential_energy_of(i);
  }
  if (kept.size() == particles.owned) return false;
  flow.neighbourhood.keep(flow.particles, kept);
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
