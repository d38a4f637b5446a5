// What comes in at open ends: particles on the rows of a lattice at the opening, each as soon as it has room.
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/for_each.h"
#include "flow/flow.h"
#include "open_ends/open_ends.h"

namespace tailwater {
namespace {

/// [dx]; how far behind the opening new particles stand that follow no others: as in the first column of a lattice that
/// ends there.
constexpr double first_entry = 0.5;
/// [dx]; how far behind the opening a particle stands at least that comes in where a level is prescribed: one at the
/// very plane would leave and enter again with every tremble of water at rest.
constexpr double least_entry = 0.25;

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
  const double spacing = volume ? *volume / (row_height * column_width) : flow.setup.scale.spacing;
  const std::vector<double> free = free_lengths(end, state, flow);
  std::vector<Entrant<Dim>> entrants;
  for (std::size_t cell = 0; cell < free.size(); ++cell) {
    const bool follows = free[cell] < 2.0 * spacing;
    const double distance = follows ? free[cell] - spacing : first_entry * spacing;
    if (distance < (end.holds_level() ? least_entry * spacing : 0.0)) continue;
    const std::size_t row = cell / static_cast<std::size_t>(end.columns);
    const std::size_t column = cell % static_cast<std::size_t>(end.columns);
    const double z = (static_cast<double>(row) + 0.5) * row_height;
    const double y = (static_cast<double>(column) + 0.5) * column_width;
    Entrant<Dim> entrant;
    entrant.position = end.low + z * end.rise + y * end.aside - distance * end.opening.normal;
    entrant.velocity =
        end.flow.feeds() ? end.inflow_at(state, entrant.position) : Vec<Dim>(-state.entry_speed * end.opening.normal);
    if (end.opening.normal.dot(entrant.velocity) >= 0.0) continue;
    entrant.pressure = end.pressure_at(state, entrant.position, flow.setup.liquid.density);
    entrant.volume = volume ? *volume : row_height * column_width * spacing;
    entrants.push_back(entrant);
  }
  return entrants;
}

/// What enters where water circulates: as many as wait in the `sump`, of their mean volume, so that number and volume
/// are kept. Those that have waited longest come first.
template <int Dim>
std::vector<Entrant<Dim>> find_returning(const OpenEnd<Dim>& end, OpenEndState& state, const Flow<Dim>& flow,
                                         const WaterAmount& sump) {
  const double number = static_cast<double>(sump.particles);
  const double cell = power<Dim>(flow.setup.scale.spacing);
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
  particles.add(own.size(), [&](std::size_t n) -> NewParticle<Dim> {
    const Entrant<Dim>& entrant = entrants[own[n]];
    return {.position = entrant.position,
            .velocity = entrant.velocity,
            .pressure = entrant.pressure,
            .volume = entrant.volume,
            .id = first_id + static_cast<std::int64_t>(own[n])};
  });
}

}  // namespace

template <int Dim>
bool OpenEnds<Dim>::bring_in(Flow<Dim>& flow) {
  const Setup<Dim>& setup = flow.setup;
  bool some_came = false;
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    if (!ends_[e].is_driven()) continue;
    const OpenEnd<Dim>& end = ends_[e];
    OpenEndState& state = states_[e];
    const std::vector<Entrant<Dim>> entrants = end.circuit < 0 ? find_entrants(end, state, flow, std::nullopt)
                                                               : find_returning(end, state, flow, sump(end.circuit));
    if (entrants.empty()) continue;
    some_came = true;
    std::int64_t first_id = setup.first_wall_id + flow.walls.particles.numbers;
    for (const OpenEndState& any : states_) first_id += any.arrived.particles;
    add_water(flow, entrants, first_id);
    for (const Entrant<Dim>& entrant : entrants) {
      const double mass = setup.liquid.density * entrant.volume;
      state.arrived +=
          {1, entrant.volume, mass * (0.5 * entrant.velocity.squaredNorm() - setup.gravity.dot(entrant.position))};
    }
  }
  return some_came;
}

template bool OpenEnds<2>::bring_in(Flow<2>&);
template bool OpenEnds<3>::bring_in(Flow<3>&);

}  // namespace tailwater
