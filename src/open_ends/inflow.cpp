// Inflow at open ends: particles enter on the rows of a lattice at the opening, each as soon as there is free space.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/for_each.h"
#include "flow/distribution.h"
#include "flow/flow.h"
#include "flow/ids_of_inflow.h"
#include "flow/pores.h"
#include "neighbours/neighbourhood.h"
#include "open_ends/open_ends.h"

namespace tailwater {
namespace {

/// [dx]; how far behind the opening new particles stand that follow no others: as in the first column of a lattice that
/// ends there.
constexpr double first_entry = 0.5;
/// [dx]; how far behind the opening a particle stands at least that comes in where a level is prescribed: one at the
/// very plane would leave and enter again with every tremble of water at rest.
constexpr double min_entry = 0.25;

/// [dx]; least distance of a particle that enters from other water. And the least free volume of its row, over its own
/// volume: a row of an even lattice that can just take a particle has half of it free.
constexpr double closest_entry = 0.7;
constexpr double min_free_volume = 0.25;

/// A particle that comes in.
template <int Dim>
struct Entrant {
  Vec<Dim> position;
  Vec<Dim> velocity;
  double pressure;
  double volume;
  int liquid;
  double layer_viscosity;
};

/// The cells at an opening in which particles enter: rows that divide the depth of each column, from the bottom
/// upwards.
template <int Dim>
class EntryLattice {
 public:
  EntryLattice(const OpenEnd<Dim>& end, const OpenEndState& state) : end_(end), rows_(state.rows) {
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      first_.push_back(first_.back() + static_cast<std::size_t>(rows_[c]));
      height_.push_back(rows_[c] > 0 ? end.depth_in(c, state) / static_cast<double>(rows_[c]) : 0.0);
    }
  }

  std::size_t size() const { return first_.back(); }
  /// Area [m^(Dim-1)] of a cell.
  double area(std::size_t cell) const {
    const std::size_t c = column_of(cell);
    return height_[c] * end_.columns[c].width;
  }
  /// The middle of a cell, in the opening.
  Vec<Dim> middle(std::size_t cell) const {
    const std::size_t c = column_of(cell);
    const double z = end_.columns[c].bottom + (static_cast<double>(cell - first_[c]) + 0.5) * height_[c];
    return end_.low + z * end_.rise + end_.columns[c].aside * end_.aside;
  }
  /// Calls with the cell straight before a place, and with those beside it up to `around` columns and rows away.
  template <class Body>
  void for_cells_at(const Vec<Dim>& x, std::size_t around, Body&& body) const {
    if (rows_.empty()) return;
    const std::size_t middle = end_.column_at(x);
    const std::size_t last = std::min(middle + around, rows_.size() - 1);
    for (std::size_t c = middle - std::min(middle, around); c <= last; ++c) {
      if (rows_[c] == 0) continue;
      const auto row = static_cast<std::int64_t>(std::floor(end_.height_in(c, x) / height_[c]));
      const auto beside = static_cast<std::int64_t>(around);
      for (std::int64_t k = std::max<std::int64_t>(0, row - beside); k <= std::min(row + beside, rows_[c] - 1); ++k) {
        body(first_[c] + static_cast<std::size_t>(k));
      }
    }
  }
  /// Calls with the two cells between whose middles a place is, and with the weight of each.
  template <class Body>
  void for_rows_around(const Vec<Dim>& x, Body&& body) const {
    const std::size_t c = rows_.empty() ? 0 : end_.column_at(x);
    if (rows_.empty() || rows_[c] == 0) return;
    const double place = std::clamp(end_.height_in(c, x) / height_[c] - 0.5, 0.0, static_cast<double>(rows_[c] - 1));
    const auto row = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(row);
    body(first_[c] + row, 1.0 - share);
    if (share > 0.0) body(first_[c] + row + 1, share);
  }

 private:
  std::size_t column_of(std::size_t cell) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(first_, cell) - first_.begin()) - 1;
  }

  const OpenEnd<Dim>& end_;
  const std::vector<std::int64_t>& rows_;
  std::vector<std::size_t> first_{0};  ///< cell of each column, and the number of all
  std::vector<double> height_;         ///< m; of the cells of each column
};

/// Length [m] behind the opening over which each cell is free of water, over all ranks.
template <int Dim>
std::vector<double> free_lengths(const OpenEnd<Dim>& end, const EntryLattice<Dim>& lattice, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> length(lattice.size(), end.stretch);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several may stand in a cell
    const Vec<Dim>& x = particles.position[i];
    if (!particles.is_fluid(i) || !end.holds(x)) continue;
    lattice.for_cells_at(x, 0,
                         [&](std::size_t cell) { length[cell] = std::min(length[cell], -end.opening.beyond(x)); });
  }
  flow.setup.ranks.min_of_each(length);
  return length;
}

/// Volume [m^Dim] of each row of the buffer that no water fills, over all ranks, weighted by a factor that
/// falls from 1 at the opening to 0 where the buffer begins. In a lattice whose first column stands one spacing behind
/// the opening half a particle is missing.
template <int Dim>
std::vector<double> free_volumes(const OpenEnd<Dim>& end, const EntryLattice<Dim>& lattice, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> volume(lattice.size(), 0.0);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several may stand in a row
    const Vec<Dim>& x = particles.position[i];
    if (!particles.is_fluid(i) || !end.holds(x)) continue;
    const double weighted = particles.volume[i] * (1.0 + end.opening.beyond(x) / end.stretch);
    lattice.for_rows_around(x, [&](std::size_t cell, double share) { volume[cell] -= share * weighted; });
  }
  flow.setup.ranks.sum_of_each(volume);
  for (std::size_t cell = 0; cell < volume.size(); ++cell) volume[cell] += 0.5 * lattice.area(cell) * end.stretch;
  return volume;
}

/// Mean of nu~ [m^2/s] in each row of the water before the buffer, over all ranks: that of water which enters with the
/// profile of a channel that continues beyond the opening. 0 with a uniform profile, whose water has no boundary layer.
template <int Dim>
std::vector<double> layers_before(const OpenEnd<Dim>& end, const EntryLattice<Dim>& lattice, const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> mean(lattice.size(), 0.0);
  if (end.flow.profile.empty()) return mean;
  std::vector<double> sums(2 * lattice.size(), 0.0);   // of each row: volume, and volume times nu~
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several may stand in a row
    const Vec<Dim>& x = particles.position[i];
    const double before = -end.behind_border(x);
    if (!particles.is_fluid(i) || before <= 0.0 || before > 2.0 * end.gauge || !end.opening.spans(x)) continue;
    lattice.for_rows_around(x, [&](std::size_t cell, double share) {
      sums[2 * cell] += share * particles.volume[i];
      sums[2 * cell + 1] += share * particles.volume[i] * particles.layer_viscosity[i];
    });
  }
  flow.setup.ranks.sum_of_each(sums);
  for (std::size_t cell = 0; cell < mean.size(); ++cell) {
    if (sums[2 * cell] > 0.0) mean[cell] = sums[2 * cell + 1] / sums[2 * cell];
  }
  return mean;
}

/// Takes out what would stand too near to other water, or in a row that is full of it, as where water has left its row.
/// All ranks find the same.
template <int Dim>
void remove_crowded(const OpenEnd<Dim>& end, const EntryLattice<Dim>& lattice, const Flow<Dim>& flow,
                    std::vector<std::optional<Entrant<Dim>>>& of_cell) {
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> nearest(lattice.size(), end.stretch);
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several may be near a cell
    const Vec<Dim>& x = particles.position[i];
    if (!particles.is_fluid(i) || !end.holds(x)) continue;
    lattice.for_cells_at(x, 1, [&](std::size_t cell) {
      if (of_cell[cell]) nearest[cell] = std::min(nearest[cell], (of_cell[cell]->position - x).norm());
    });
  }
  flow.setup.ranks.min_of_each(nearest);
  const std::vector<double> free = free_volumes(end, lattice, flow);
  for (std::size_t cell = 0; cell < nearest.size(); ++cell) {
    std::optional<Entrant<Dim>>& entrant = of_cell[cell];
    const bool has_room = nearest[cell] >= closest_entry * end.spacing;
    if (entrant && (!has_room || free[cell] < min_free_volume * entrant->volume)) entrant.reset();
  }
}

/// The particles that can enter now, of a `volume` [m^Dim] of water, or as large as a cell of the lattice one spacing
/// long. Each stands the length of its cell before the next in its row. All ranks get the same.
template <int Dim>
std::vector<Entrant<Dim>> find_entrants(const OpenEnd<Dim>& end, const OpenEndState& state, const Flow<Dim>& flow,
                                        const LiquidsBeyond& liquids, const std::optional<double>& volume) {
  const EntryLattice<Dim> lattice(end, state);
  const double growth = end.stretch * state.depth_rate / std::max(state.depth, end.spacing);
  if (lattice.size() == 0 || (end.flow.feeds() && state.entry_speed + growth <= 0.0)) return {};
  const std::vector<double> free = free_lengths(end, lattice, flow);
  const std::vector<double> layers = layers_before(end, lattice, flow);
  std::vector<std::optional<Entrant<Dim>>> of_cell(lattice.size());
  for (std::size_t cell = 0; cell < lattice.size(); ++cell) {
    const double fraction = filled_fraction(flow.pores, lattice.middle(cell));
    const double length = volume ? *volume / (fraction * lattice.area(cell)) : end.spacing;
    const double distance = free[cell] < 2.0 * length ? free[cell] - length : first_entry * length;
    if (distance < (end.holds_level() ? min_entry * length : 0.0)) continue;
    const Vec<Dim> position = lattice.middle(cell) - distance * end.opening.normal;
    const Vec<Dim> velocity = end.velocity_at(state, position);
    const double pressure = end.pressure_at(state, position, velocity, deceleration(flow.pores, position, velocity),
                                            density_above(flow, end, state, liquids, position));
    if (end.opening.normal.dot(velocity) >= 0.0 || (end.holds_level() && pressure <= 0.0)) continue;
    of_cell[cell] = {position,
                     velocity / fraction,
                     pressure,
                     volume ? *volume / fraction : lattice.area(cell) * length,
                     liquids.at(end.rise.dot(position - end.low)),
                     layers[cell]};
  }
  remove_crowded(end, lattice, flow, of_cell);
  std::vector<Entrant<Dim>> entrants;
  for (const std::optional<Entrant<Dim>>& entrant : of_cell) {
    if (entrant) entrants.push_back(*entrant);
  }
  return entrants;
}

/// The particles that enter where water circulates: at most as many as wait in the `sump`, of their mean volume, so
/// that number and volume are conserved. Those that have waited longest enter first.
template <int Dim>
std::vector<Entrant<Dim>> find_returning(const OpenEnd<Dim>& end, OpenEndState& state, const Flow<Dim>& flow,
                                         const LiquidsBeyond& liquids, const WaterAmount& sump) {
  const double number = static_cast<double>(sump.particles);
  const double cell = power<Dim>(end.spacing);
  std::vector<Entrant<Dim>> entrants =
      find_entrants(end, state, flow, liquids, std::optional(sump.particles > 0 ? sump.volume / number : cell));
  const auto waiting = static_cast<std::size_t>(sump.particles);
  if (entrants.size() > waiting) {
    const auto inside = [&](const Entrant<Dim>& entrant) { return -end.opening.beyond(entrant.position); };
    std::ranges::stable_sort(entrants, std::greater<>(), inside);
    entrants.resize(waiting);
    ++state.short_steps;
  }
  return entrants;
}

/// Makes particles of those whose places this rank owns, with the id `id_of` of each number. Ghosts and lists are
/// forgotten.
template <int Dim, class IdOf>
void add_water(Flow<Dim>& flow, const std::vector<Entrant<Dim>>& entrants, IdOf&& id_of) {
  const Communicator& ranks = flow.setup.ranks;
  Particles<Dim>& particles = flow.state.particles;
  flow.neighbourhood->forget(particles);
  const std::vector<std::size_t> own = indices_where(entrants.size(), [&](std::size_t n) {
    return ranks.is_alone() || flow.distribution->decomposition.cuts().part_of(entrants[n].position) == ranks.rank();
  });
  particles.add(own.size(), [&](std::size_t n) -> NewParticle<Dim> {
    const Entrant<Dim>& entrant = entrants[own[n]];
    return {.position = entrant.position,
            .velocity = entrant.velocity,
            .pressure = entrant.pressure,
            .volume = entrant.volume,
            .id = id_of(own[n])};
  });
  for_each(own.size(), [&](std::size_t n) {
    particles.layer_viscosity[particles.owned - own.size() + n] = entrants[own[n]].layer_viscosity;
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
    const std::vector<Entrant<Dim>> entrants =
        end.circuit < 0 ? find_entrants(end, state, flow, liquids_[e], std::nullopt)
                        : find_returning(end, state, flow, liquids_[e], sump(end.circuit, setup.liquid.density));
    if (entrants.empty()) continue;
    some_came = true;
    const std::int64_t first_id = setup.first_wall_id + flow.walls.particles.numbers;
    const bool are_several = setup.liquids.are_several();
    std::int64_t earlier = 0;
    for (const OpenEndState& any : states_) earlier += any.arrived.particles;
    if (are_several) earlier = state.arrived.particles;
    add_water(flow, entrants, [&](std::size_t n) {
      const std::int64_t range =
          are_several ? range_of_inflow(e, static_cast<std::size_t>(entrants[n].liquid), setup.liquids.density.size())
                      : 0;
      return first_id + range * ids_in_range + earlier + static_cast<std::int64_t>(n);
    });
    for (const Entrant<Dim>& entrant : entrants) {
      const double density =
          are_several ? setup.liquids.density[static_cast<std::size_t>(entrant.liquid)] : setup.liquid.density;
      const double volume = filled_fraction(flow.pores, entrant.position) * entrant.volume;
      const double mass = density * volume;
      state.arrived +=
          {1, volume, mass, mass * (0.5 * entrant.velocity.squaredNorm() - setup.gravity.dot(entrant.position))};
    }
  }
  return some_came;
}

template bool OpenEnds<2>::bring_in(Flow<2>&);
template bool OpenEnds<3>::bring_in(Flow<3>&);

}  // namespace tailwater
