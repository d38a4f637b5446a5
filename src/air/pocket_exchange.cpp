#include "air/pocket_exchange.h"

#include <algorithm>
#include <limits>

namespace tailwater {
namespace {

/// A pocket that begins and is larger than this fraction of its neighbour was not separated from it. The space has been
/// closed since the last search, and the air is new.
constexpr double max_taken_fraction = 0.5;

/// Maximum fraction of its volume that a pocket loses in a correction.
constexpr double max_corrected_fraction = 0.5;

/// Square of the distance between two runs of cells, in cells. Periodic borders are ignored.
template <int Dim>
double square_between(const VoidGrid<Dim>& grid, const CellRun& a, const CellRun& b) {
  const auto first = grid.cell(a.row, a.begin);
  const auto other = grid.cell(b.row, b.begin);
  double square = 0.0;
  for (int d = 0; d < Dim - 1; ++d) square += (first[d] - other[d]) * (first[d] - other[d]);
  const int gap = std::max({0, b.begin - a.end, a.begin - b.end});
  return square + gap * gap;
}

/// The pocket of a space that is nearest to these cells and for which is_allowed(n), as an index; -1: there is none.
template <int Dim, class Allowed>
int nearest_pocket(const VoidGrid<Dim>& grid, std::span<const FoundPocket> found, int space,
                   std::span<const CellRun> cells, Allowed&& is_allowed) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (found[n].space != space || !is_allowed(n)) continue;
    for (const CellRun& a : cells) {
      if (a.row < 0 || a.row >= grid.rows()) continue;  // a checkpoint may hold any number
      for (const CellRun& b : found[n].pocket.cells) {
        const double square = square_between(grid, a, b);
        if (square >= least) continue;
        least = square;
        nearest = static_cast<int>(n);
      }
    }
  }
  return nearest;
}

/// A pocket without volume yet has no energy.
double energy_of(const GasLaw& law, const AirPocket& pocket) {
  return pocket.volume > 0.0 ? law.energy(pocket.gas, pocket.volume) : 0.0;
}

/// Moves a fraction of the gas and the volume of one pocket to another. The energy lost by mixing is recorded.
void move_gas(AirPocket& from, AirPocket& to, double fraction, const GasLaw& law, AirState& state) {
  const double before = energy_of(law, from) + energy_of(law, to);
  const double gas = fraction * from.gas;
  const double volume = fraction * from.volume;
  to.gas += gas;
  to.volume += volume;
  from.gas -= gas;
  from.volume -= volume;
  state.energy_lost += before - energy_of(law, from) - energy_of(law, to);
}

/// Gives the gas without a pocket to pockets.
template <int Dim>
void hand_on(const VoidGrid<Dim>& grid, const SealedSpaces<Dim>& spaces, const GasLaw& law,
             std::vector<FoundPocket>& found, AirState& state) {
  std::vector<AirPocket> kept;
  for (AirPocket& hidden : state.hidden) {
    const int space = spaces.of(grid, hidden.cells);
    if (space < 0) {
      state.gas_lost += hidden.gas;
      state.energy_lost += law.energy(hidden.gas, hidden.volume);
      continue;
    }
    const int heir = nearest_pocket<Dim>(grid, found, space, hidden.cells, [](std::size_t) { return true; });
    if (heir < 0) {
      kept.push_back(std::move(hidden));
      continue;
    }
    state.gas_handed_on += hidden.gas;
    move_gas(hidden, found[heir].pocket, 1.0, law, state);
  }
  state.hidden = std::move(kept);
}

/// Gives a pocket that begins, or has grown over cells of the water, its part of the neighbour's gas.
template <int Dim>
void take_part(const VoidGrid<Dim>& grid, std::size_t n, double volume, const GasLaw& law,
               std::vector<FoundPocket>& found, AirState& state) {
  FoundPocket& begins = found[n];
  const double wanted = begins.new_share * volume;
  const int donor = nearest_pocket<Dim>(grid, found, begins.space, begins.pocket.cells, [&](std::size_t other) {
    return other != n && wanted <= max_taken_fraction * found[other].pocket.volume;
  });
  if (donor < 0) {
    if (max_taken_fraction * wanted <= begins.pocket.volume) begins.new_share = 0.0;  // it has gas that was hidden
    return;
  }
  begins.new_share = 0.0;
  move_gas(found[donor].pocket, begins.pocket, wanted / found[donor].pocket.volume, law, state);
}

/// Brings the volume of a pocket towards that of its cells by the fraction `pace`.
void correct_volume(AirPocket& pocket, AirPocket& largest, double volume, double pace, const GasLaw& law,
                    AirState& state) {
  const double excess = pace * (pocket.volume - volume);
  AirPocket& from = excess > 0.0 ? pocket : largest;
  AirPocket& to = excess > 0.0 ? largest : pocket;
  move_gas(from, to, std::min(std::abs(excess) / from.volume, max_corrected_fraction), law, state);
}

}  // namespace

std::vector<int> largest_of_space(std::span<const FoundPocket> found) {
  std::vector<int> largest(found.size(), -1);
  for (std::size_t n = 0; n < found.size(); ++n) {
    for (std::size_t other = 0; found[n].space >= 0 && other < found.size(); ++other) {
      if (found[other].space != found[n].space) continue;
      if (largest[n] < 0 || found[other].pocket.volume > found[largest[n]].pocket.volume) {
        largest[n] = static_cast<int>(other);
      }
    }
  }
  return largest;
}

template <int Dim>
void exchange_gas(const VoidGrid<Dim>& grid, const SealedSpaces<Dim>& spaces, std::span<const double> volumes,
                  std::int64_t begun_before, double pace, const GasLaw& law, std::vector<FoundPocket>& found,
                  AirState& state) {
  hand_on(grid, spaces, law, found, state);
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (found[n].space >= 0 && found[n].new_share > 0.0) take_part(grid, n, volumes[n], law, found, state);
  }
  const std::vector<int> largest = largest_of_space(found);
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (largest[n] < 0) continue;
    const auto main = static_cast<std::size_t>(largest[n]);
    found[n].keeps_volume = main != n || spaces.is_rigid(found[n].space);
    if (main == n || found[n].new_share > 0.0) continue;
    const bool is_new = found[n].pocket.number >= begun_before;
    correct_volume(found[n].pocket, found[main].pocket, volumes[n], is_new ? 1.0 : pace, law, state);
  }
}

TAILWATER_IN_2D_AND_3D(exchange_gas);

}  // namespace tailwater
