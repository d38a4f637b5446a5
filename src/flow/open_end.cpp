#include "flow/open_end.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/for_each.h"
#include "flow/verbs.h"

namespace tailwater {
namespace {

constexpr double gauge_over_spacing = 2.0;
/// Water shallower than this share of dx gives no reliable level.
constexpr double least_depth_over_spacing = 0.1;
/// Time over which the invariant is averaged, in travel times of a long wave from the gauge into the end stretch. It is
/// long compared with the waves that must leave, because whatever the mean follows is let back in
/// (docs/theory/open_ends.md).
constexpr double memory = 100.0;
/// [dx]; rows of the entering lattice are one more or one less when they have become that much too high or too low
/// together. Half of it would do; the rest keeps a level that trembles from changing them again and again.
constexpr double most_row_error = 0.75;
/// [dx]; how far behind the opening new particles stand that follow no others: as in the first column of a lattice that
/// ends there.
constexpr double first_entry = 0.5;

/// Sums over the water before the end stretch, weighted by a tent of half width `gauge`. With a half width of two
/// lattice columns the tent counts a lattice exactly wherever it stands.
struct Reading {
  double volume = 0.0;  ///< m^Dim
  double flux = 0.0;    ///< m^(Dim+1)/s; times the velocity along the opening's normal
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
    const double off = std::abs(end.opening.beyond(x) + end.stretch + end.gauge);
    if (off >= end.gauge || !end.opening.spans(x)) return {};
    const double share = (1.0 - off / end.gauge) * particles.volume[i];
    return {share, share * end.opening.normal.dot(particles.velocity[i]), share * particles.pressure[i]};
  });
}

/// Updates `state` from the flow before the end stretch and returns the change of its speed, m/s.
template <int Dim>
double read_flow(const OpenEnd<Dim>& end, const Flow<Dim>& flow, const Reading& reading, double dt,
                 OpenEndState& state) {
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
    state.mean_speed = speed;
  } else if (celerity > 0.0) {
    const double crossing = end.distance() / celerity;
    state.wet_time += dt;
    const double window = std::clamp(state.wet_time, crossing, memory * crossing);
    const double rate = 1.0 / window + std::max(0.0, speed - celerity) / end.gauge;
    state.invariant += (1.0 - std::exp(-rate * dt)) * (invariant - state.invariant);
    state.mean_speed += (1.0 - std::exp(-dt / window)) * (speed - state.mean_speed);
    state.speed_beyond +=
        (1.0 - std::exp(-dt * (std::abs(speed) + celerity) / end.distance())) * (speed - state.speed_beyond);
  }
  state.speed = speed;
  if (end.flow.level && end.gravity > 0.0) state.depth_at_gauge = celerity_squared / end.gravity;
  return change;
}

/// Depth [m] of a flow with speed u and the invariant that comes from beyond.
double depth_at_speed(double invariant, double gravity, double u) {
  const double twice_celerity = std::max(0.0, u - invariant);
  return 0.25 * twice_celerity * twice_celerity / gravity;
}

/// Where a level is prescribed: depths in the end stretch and at the gauge, and the speed with which water enters. The
/// level holds for the mean flow; waves pass. Returns the change of the speed before the end stretch, m/s.
template <int Dim>
double hold_level(const OpenEnd<Dim>& end, const Flow<Dim>& flow, const Reading& reading, double time, double dt,
                  OpenEndState& state) {
  const double change = read_flow(end, flow, reading, dt, state);
  const double prescribed = end.depth_at_level(end.flow.level->at(time));
  if (!state.is_wet) {  // it floods a dry case as over a brink
    state.depth = state.depth_at_gauge = prescribed;
    state.entry_speed = std::sqrt(end.gravity * prescribed);
    return 0.0;
  }
  const double own = state.depth_at_gauge;
  const double celerity = std::sqrt(end.gravity * prescribed);
  const double invariant = std::max(state.mean_speed, -celerity) - 2.0 * celerity;  // no more enters than critical flow
  const auto depth_at = [&](double u) {
    // Water that falls over a brink is critical there, and no level beyond is felt.
    const double least = u > 0.0 ? std::min(own, u * u / end.gravity) : 0.0;
    return std::min(std::max(depth_at_speed(invariant, end.gravity, u), least), end.height);
  };
  state.depth_at_gauge = depth_at(state.speed);
  state.depth = depth_at(state.speed_beyond);
  state.entry_speed = -state.speed;
  return change;
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
  state.entry_speed = depth > 0.0 ? end.discharge_per_width(time, depth) / depth : 0.0;
}

/// Rows of the lattice on which particles enter.
void choose_rows(double spacing, OpenEndState& state) {
  const double wanted = state.depth / spacing;
  const bool fit = state.rows > 0 && std::abs(wanted - static_cast<double>(state.rows)) <= most_row_error;
  if (!fit) state.rows = std::lround(wanted);
}

/// A particle that comes in.
template <int Dim>
struct Entrant {
  Vec<Dim> position;
  Vec<Dim> velocity;
  double pressure;
  double volume;
};

/// How far [m] behind the opening each cell of the lattice at it is free of water, over all ranks; row by row.
template <int Dim>
std::vector<double> free_lengths(const OpenEnd<Dim>& end, const OpenEndState& state, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const double row_height = state.depth / static_cast<double>(state.rows);
  const double column_width = end.width / end.columns;
  std::vector<double> length(static_cast<std::size_t>(state.rows) * end.columns, end.stretch);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several may stand in a cell
    const Vec<Dim>& x = particles.position[i];
    if (!particles.is_fluid(i) || !end.holds(x)) continue;
    const Vec<Dim> place = x - end.low;
    const auto row = static_cast<std::int64_t>(end.rise.dot(place) / row_height);
    const auto column = static_cast<std::int64_t>(end.aside.dot(place) / column_width);
    if (row >= state.rows || column >= end.columns) continue;  // above the water, or on the rim
    double& free = length[static_cast<std::size_t>(row * end.columns + column)];
    free = std::min(free, -end.opening.beyond(x));
  }
  flow.setup.ranks.least_of_each(length);
  return length;
}

/// The particles of a `volume` [m^Dim], or as large as a cell of the lattice one spacing long, that have room to enter
/// now: each stands the length of its cell before the next in its row. All ranks find the same.
template <int Dim>
std::vector<Entrant<Dim>> find_entrants(const OpenEnd<Dim>& end, const OpenEndState& state, const Flow<Dim>& flow,
                                        const std::optional<double>& volume) {
  if (state.rows == 0 || state.entry_speed <= 0.0) return {};
  const double row_height = state.depth / static_cast<double>(state.rows);
  const double column_width = end.width / end.columns;
  const double spacing = volume ? *volume / (row_height * column_width) : flow.setup.spacing;
  const std::vector<double> free = free_lengths(end, state, flow);
  std::vector<Entrant<Dim>> entrants;
  for (std::size_t cell = 0; cell < free.size(); ++cell) {
    const bool follows = free[cell] < 2.0 * spacing;
    const double way = follows ? free[cell] - spacing : first_entry * spacing;
    if (way < 0.0) continue;
    const std::size_t row = cell / static_cast<std::size_t>(end.columns);
    const std::size_t column = cell % static_cast<std::size_t>(end.columns);
    const double z = (static_cast<double>(row) + 0.5) * row_height;
    const double y = (static_cast<double>(column) + 0.5) * column_width;
    Entrant<Dim> entrant;
    entrant.position = end.low + z * end.rise + y * end.aside - way * end.opening.normal;
    entrant.velocity =
        end.flow.feeds() ? end.inflow_at(state, entrant.position) : Vec<Dim>(-state.entry_speed * end.opening.normal);
    if (end.opening.normal.dot(entrant.velocity) >= 0.0) continue;
    entrant.pressure = end.pressure_at(state, entrant.position, flow.setup.density);
    entrant.volume = volume ? *volume : row_height * column_width * spacing;
    entrants.push_back(entrant);
  }
  return entrants;
}

/// What enters where water circulates: as many as wait in the sump, of their mean volume, so that number and volume are
/// kept. Those that have waited longest come first.
template <int Dim>
std::vector<Entrant<Dim>> find_returning(const OpenEnd<Dim>& end, OpenEndState& state, const Flow<Dim>& flow) {
  const Passed sump = sump_of(flow, end.circuit);
  const double number = static_cast<double>(sump.particles);
  const double cell = power<Dim>(flow.setup.spacing);
  std::vector<Entrant<Dim>> entrants =
      find_entrants(end, state, flow, std::optional(sump.particles > 0 ? sump.volume / number : cell));
  const auto waiting = static_cast<std::size_t>(sump.particles);
  if (entrants.size() > waiting) {
    const auto inside = [&](const Entrant<Dim>& entrant) { return -end.opening.beyond(entrant.position); };
    std::ranges::stable_sort(entrants, std::greater<>(), inside);
    entrants.resize(waiting);
    ++state.short_steps;
  }
  return entrants;
}

/// Makes particles of those whose places this rank owns. Ghosts and lists are forgotten.
template <int Dim>
void add_water(Flow<Dim>& flow, const std::vector<Entrant<Dim>>& entrants, std::int64_t first_id) {
  const Communicator& ranks = flow.setup.ranks;
  Particles<Dim>& particles = flow.state.particles;
  flow.neighbourhood.forget(particles);
  const std::vector<std::size_t> own = indices_where(entrants.size(), [&](std::size_t n) {
    return ranks.is_alone() || flow.decomposition.cuts().part_of(entrants[n].position) == ranks.rank();
  });
  const std::size_t before = particles.owned;
  particles.owned += own.size();
  particles.resize(particles.owned);
  for_each(own.size(), [&](std::size_t n) {
    const std::size_t i = before + n;
    const Entrant<Dim>& entrant = entrants[own[n]];
    particles.position[i] = entrant.position;
    particles.velocity[i] = entrant.velocity;
    particles.pressure[i] = entrant.pressure;
    particles.second_pressure[i] = 0.0;
    particles.volume[i] = entrant.volume;
    particles.kind[i] = ParticleKind::fluid;
    particles.wall_row[i] = -1;
    particles.layer_viscosity[i] = 0.0;
    particles.wall_distance[i] = far_from_walls;
    particles.id[i] = first_id + static_cast<std::int64_t>(own[n]);
  });
}

/// Kinetic energy [J] of this rank's water in driven end stretches.
template <int Dim>
double kinetic_energy_in_driven_ends(const Flow<Dim>& flow) {
  return sum_over(flow.state.particles.owned, 0.0,
                  [&](std::size_t i) { return flow.is_driven(i) ? flow.kinetic_energy_of(i) : 0.0; });
}

}  // namespace

Passed& Passed::operator+=(const Passed& other) {
  particles += other.particles;
  volume += other.volume;
  energy += other.energy;
  return *this;
}

Passed& Passed::operator-=(const Passed& other) {
  particles -= other.particles;
  volume -= other.volume;
  energy -= other.energy;
  return *this;
}

template <int Dim>
OpenEnd<Dim>::OpenEnd(ChannelEnd<Dim> end, double spacing, double support)
    : ChannelEnd<Dim>(std::move(end)),
      stretch(support + spacing),
      gauge(gauge_over_spacing * spacing),
      columns(Dim == 2 ? 1 : std::max(1, static_cast<int>(std::lround(this->width / spacing)))) {}

template <int Dim>
double OpenEnd<Dim>::pressure_at(const OpenEndState& state, const Vec<Dim>& x, double density) const {
  if (this->gravity == 0.0 || !(state.is_wet || this->is_driven())) return 0.0;
  double level = this->floor + state.depth;
  if (!this->flow.feeds()) {
    const auto depth_at = [&](double speed) { return depth_at_speed(state.invariant, this->gravity, speed); };
    const double at_gauge = this->is_driven() ? state.depth_at_gauge : depth_at(state.speed);
    const double in_middle = this->is_driven() ? state.depth : depth_at(state.speed_beyond);
    const double share = (this->opening.beyond(x) + stretch + gauge) / distance();
    level = this->floor + (1.0 - share) * at_gauge + share * in_middle;
  }
  return density * this->gravity * std::max(0.0, level - this->up.dot(x));
}

/// The water may become deeper or shallower. Then it is stretched along `rise`, and what it gains or loses along the
/// channel makes up for it: the field has no divergence, and the discharge at the opening is the prescribed one.
template <int Dim>
Vec<Dim> OpenEnd<Dim>::inflow_at(const OpenEndState& state, const Vec<Dim>& x) const {
  if (state.depth == 0.0) return Vec<Dim>::Zero();
  const double share = this->rise.dot(x - this->low) / state.depth;
  const double inside = -this->opening.beyond(x);
  const double row = state.rows > 0 ? 1.0 / static_cast<double>(state.rows) : 1.0;
  const double in =
      state.entry_speed * this->flow.profile_of_row(share, row) - inside * state.depth_rate / state.depth;
  return -in * this->opening.normal + share * state.depth_rate * this->rise;
}

template <int Dim>
void hold_open_ends(Flow<Dim>& flow, double dt) {
  Particles<Dim>& particles = flow.state.particles;
  flow.end_of.assign(particles.owned, -1);
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const OpenEnd<Dim>& end = flow.setup.open_ends[e];
    for_each(particles.owned, [&](std::size_t i) {
      if (particles.is_fluid(i) && end.holds(particles.position[i])) flow.end_of[i] = static_cast<std::int16_t>(e);
    });
  }
  flow.driven_change = -kinetic_energy_in_driven_ends(flow);
  const double time = flow.state.time + 0.5 * dt;
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const OpenEnd<Dim>& end = flow.setup.open_ends[e];
    OpenEndState& state = flow.state.open_ends[e];
    Reading reading = read_gauge(end, particles);
    flow.setup.ranks.sum_each(reading.volume, reading.flux, reading.push);
    double change = 0.0;
    if (end.flow.feeds()) {
      hold_inflow(end, reading, time, dt, flow.setup.spacing, state);
    } else if (end.flow.level) {
      change = hold_level(end, flow, reading, time, dt, state);
    } else {
      change = read_flow(end, flow, reading, dt, state);
    }
    if (end.is_driven()) choose_rows(flow.setup.spacing, state);
    const Vec<Dim>& normal = end.opening.normal;
    for_each(particles.owned, [&](std::size_t i) {
      if (flow.end_of[i] != static_cast<std::int16_t>(e)) return;
      Vec<Dim>& velocity = particles.velocity[i];
      if (end.flow.feeds()) {
        velocity = end.inflow_at(state, particles.position[i]);
      } else if (end.is_driven() && !state.is_wet) {
        velocity = -state.entry_speed * normal;
      } else {
        velocity = (normal.dot(velocity) + change) * normal;
      }
    });
  }
  flow.driven_change += kinetic_energy_in_driven_ends(flow);
}

template <int Dim>
bool let_in(Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  bool some_came = false;
  for (std::size_t e = 0; e < setup.open_ends.size(); ++e) {
    if (!setup.open_ends[e].is_driven()) continue;
    const OpenEnd<Dim>& end = setup.open_ends[e];
    OpenEndState& state = flow.state.open_ends[e];
    const std::vector<Entrant<Dim>> entrants =
        end.circuit < 0 ? find_entrants(end, state, flow, std::nullopt) : find_returning(end, state, flow);
    if (entrants.empty()) continue;
    some_came = true;
    std::int64_t first_id = setup.first_wall_id + flow.walls.particles.numbers;
    for (const OpenEndState& any : flow.state.open_ends) first_id += any.arrived.particles;
    add_water(flow, entrants, first_id);
    for (const Entrant<Dim>& entrant : entrants) {
      const double mass = setup.density * entrant.volume;
      state.arrived +=
          {1, entrant.volume, mass * (0.5 * entrant.velocity.squaredNorm() - setup.gravity.dot(entrant.position))};
    }
  }
  return some_came;
}

template <int Dim>
std::vector<OpenEnd<Dim>> make_ends(const CaseSpec& spec) {
  std::vector<OpenEnd<Dim>> ends;
  for (ChannelEnd<Dim>& end : make_channel_ends<Dim>(spec)) {
    ends.emplace_back(std::move(end), spec.particles.spacing, spec.scheme.support * spec.particles.spacing);
  }
  return ends;
}

template <int Dim>
Passed sump_of(const Flow<Dim>& flow, int circuit) {
  Passed sump;
  const double particle = power<Dim>(flow.setup.spacing);
  for (std::size_t e = 0; e < flow.setup.open_ends.size(); ++e) {
    const OpenEnd<Dim>& end = flow.setup.open_ends[e];
    if (end.circuit != circuit) continue;
    const std::int64_t reserve = std::lround(end.reserve / particle);
    sump += {reserve, static_cast<double>(reserve) * particle};
    sump += flow.state.open_ends[e].departed;
    sump -= flow.state.open_ends[e].arrived;
  }
  return sump;
}

#define TAILWATER_INSTANTIATE(Dim)                               \
  template struct OpenEnd<Dim>;                                  \
  template Passed sump_of(const Flow<Dim>&, int);                \
  template std::vector<OpenEnd<Dim>> make_ends(const CaseSpec&); \
  template void hold_open_ends<Dim>(Flow<Dim>&, double);         \
  template bool let_in<Dim>(Flow<Dim>&);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
