// Pockets follow the void from one search for it to the next. Each cell of a pocket holds an equal part of its gas and
// volume, and these move with the cell:
//
//   claim   closed parts of the void take the cells that lie in them;
//   tear    cells in the open remain a pocket for a while, because a film of water may close again;
//   end     the rest of the gas goes to other pockets of a sealed space (pocket_exchange.h), or is lost;
//   begin   closed parts become pockets: those that claimed cells, and those that are large enough to be new.
#include "air/pockets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/assert.h"

namespace tailwater {
namespace {

/// [dx]; edge of a cube as large as the smallest void, without the cells near water, that begins as a pocket or remains
/// one.
constexpr double min_edge_at_begin = 2.0;
constexpr double min_pocket_edge = 1.0;

/// [dx]; displacement of the water after which the gas of a torn pocket is lost.
constexpr double max_torn_distance = 2.0;

/// [dx]; displacement of the water in which the volume of a pocket approaches that of its cells to 1/e. It is long
/// compared with a pulsation, so that only lasting differences are removed.
constexpr double relaxation_distance = 50.0;

/// Fraction of the cells of a pocket without an earlier pocket above which the pocket has not moved there: air was shut
/// in beside it.
constexpr double min_shut_in_fraction = 0.5;

/// Fractions of a pocket that differ by less are equal up to rounding.
constexpr double fraction_rounding = 1e-12;

/// The smallest numbers of cells with which a pocket begins and remains.
struct MinCells {
  template <int Dim>
  MinCells(const VoidGrid<Dim>& grid, double spacing)
      : at_begin(power<Dim>(min_edge_at_begin * spacing) / grid.cell_volume()),
        to_remain(power<Dim>(min_pocket_edge * spacing) / grid.cell_volume()) {}

  double at_begin;
  double to_remain;
};

/// A pocket found before, and where those of its cells that are still void lie now: in closed parts of the void and in
/// the open.
struct OldPocket {
  const AirPocket& pocket;
  std::map<int, std::int64_t> closed_cells;  ///< by part of the void
  std::vector<CellRun> open_runs;
  std::int64_t open_cells = 0;
  std::int64_t void_cells = 0;  ///< closed and open
  double rest = 1.0;            ///< fraction of the gas that no new pocket has

  /// Moves as much gas and volume as `cells` of the void cells have.
  void move_to(AirPocket& receiver, std::int64_t cells) {
    const double fraction = static_cast<double>(cells) / static_cast<double>(void_cells);
    receiver.gas += fraction * pocket.gas;
    receiver.volume += fraction * pocket.volume;
    rest -= fraction;
  }
};

template <int Dim>
OldPocket find_cells(const AirPocket& pocket, const VoidGrid<Dim>& grid, const Voids<Dim>& voids) {
  OldPocket old{pocket, {}, {}};
  for (const CellRun& run : pocket.cells) {
    if (run.row < 0 || run.row >= grid.rows()) continue;  // a checkpoint may hold any number
    voids.visit_pieces(run, [&](const CellRun& piece, int part) {
      old.void_cells += piece.cells();
      if (voids.parts()[part].is_open) {
        old.open_runs.push_back(piece);
        old.open_cells += piece.cells();
      } else {
        old.closed_cells[part] += piece.cells();
      }
    });
  }
  return old;
}

/// A part of the void and its claims on old pockets.
struct Claimant {
  bool may_be_pocket = false;  ///< whether it is closed by water and large enough to remain a pocket
  AirPocket pocket;
  std::int64_t claimed_cells = 0;
  std::int64_t largest_claim = 0;  ///< cells of the old pocket whose number it has
};

/// A claimant for each part of the void.
template <int Dim>
std::vector<Claimant> make_claimants(const Voids<Dim>& voids, const MinCells& min_cells) {
  std::vector<Claimant> claimants(voids.parts().size());
  for (std::size_t p = 0; p < claimants.size(); ++p) {
    const auto& part = voids.parts()[p];
    const bool is_large = static_cast<double>(part.cells) >= min_cells.to_remain;
    claimants[p].may_be_pocket = !part.is_open && part.touches_water && is_large;
    claimants[p].pocket.number = -1;
  }
  for (std::size_t k = 0; k < voids.runs().size(); ++k) {
    Claimant& claimant = claimants[voids.part_of(k)];
    if (claimant.may_be_pocket) claimant.pocket.cells.push_back(voids.runs()[k]);
  }
  return claimants;
}

/// Closed parts of the void take their cells of an old pocket. A part gets the number of the pocket with the largest
/// claim.
void claim_cells(OldPocket& old, std::vector<Claimant>& claimants) {
  for (const auto& [part, cells] : old.closed_cells) {
    Claimant& claimant = claimants[part];
    if (!claimant.may_be_pocket) continue;
    old.move_to(claimant.pocket, cells);
    claimant.claimed_cells += cells;
    if (cells > claimant.largest_claim) {
      claimant.largest_claim = cells;
      claimant.pocket.number = old.pocket.number;
    }
  }
}

/// Makes a torn pocket of the cells in the open, unless they are too few or have been open for too long:
/// `torn_distance` [m] of the water's displacement.
void tear_off(OldPocket& old, double torn_distance, double spacing, const MinCells& min_cells,
              std::vector<FoundPocket>& torn) {
  if (static_cast<double>(old.open_cells) < min_cells.to_remain) return;
  if (torn_distance >= max_torn_distance * spacing) return;
  AirPocket pocket;
  pocket.number = old.pocket.number;
  pocket.torn = torn_distance;
  pocket.cells = std::move(old.open_runs);
  old.move_to(pocket, old.open_cells);
  torn.push_back({std::move(pocket), 0.0});
}

/// Hides the rest of an old pocket in its sealed space, or counts it as lost.
void end_pocket(const OldPocket& old, bool is_sealed, const GasLaw& law, AirState& state) {
  if (old.rest <= fraction_rounding) return;
  if (old.rest > 1.0 - fraction_rounding) ++state.ended;
  if (is_sealed) {
    AirPocket rest = old.pocket;
    rest.gas *= old.rest;
    rest.volume *= old.rest;
    state.hidden.push_back(std::move(rest));
    return;
  }
  state.gas_lost += old.rest * old.pocket.gas;
  state.energy_lost += old.rest * law.energy(old.pocket.gas, old.pocket.volume);
}

/// The closed pockets: parts of the void that have claimed cells or are large enough to be new.
template <int Dim>
std::vector<FoundPocket> begin_pockets(const Voids<Dim>& voids, const MinCells& min_cells,
                                       std::vector<Claimant> claimants) {
  std::vector<FoundPocket> found;
  for (std::size_t p = 0; p < claimants.size(); ++p) {
    Claimant& claimant = claimants[p];
    const auto cells = static_cast<double>(voids.parts()[p].cells);
    const bool is_new = claimant.claimed_cells == 0;
    if (!claimant.may_be_pocket || (is_new && cells < min_cells.at_begin)) continue;
    const double unclaimed = 1.0 - static_cast<double>(claimant.claimed_cells) / cells;
    const bool has_shut_in = unclaimed > min_shut_in_fraction && unclaimed * cells >= min_cells.at_begin;
    found.push_back({std::move(claimant.pocket), has_shut_in ? unclaimed : 0.0});
  }
  return found;
}

/// Gives numbers to new pockets, and to all but the first of those that have the number of one old pocket.
void number_pockets(std::vector<FoundPocket>& found, AirState& state) {
  for (std::size_t a = 0; a < found.size(); ++a) {
    const auto has_same = [&](const FoundPocket& other) { return other.pocket.number == found[a].pocket.number; };
    const bool is_taken = std::any_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(a), has_same);
    if (found[a].pocket.number < 0 || is_taken) found[a].pocket.number = state.begun++;
  }
}

}  // namespace

template <int Dim>
std::vector<FoundPocket> follow_pockets(const VoidGrid<Dim>& grid, double spacing, const Voids<Dim>& voids,
                                        const SealedSpaces<Dim>& spaces, const GasLaw& law, AirState& state) {
  const MinCells min_cells(grid, spacing);
  std::vector<Claimant> claimants = make_claimants(voids, min_cells);
  std::vector<FoundPocket> torn;
  for (const AirPocket& pocket : state.pockets) {
    OldPocket old = find_cells(pocket, grid, voids);
    claim_cells(old, claimants);
    tear_off(old, pocket.torn + state.displacement, spacing, min_cells, torn);
    end_pocket(old, spaces.of(grid, pocket.cells) >= 0, law, state);
  }
  std::vector<FoundPocket> found = begin_pockets(voids, min_cells, std::move(claimants));
  std::ranges::move(torn, std::back_inserter(found));
  number_pockets(found, state);
  for (FoundPocket& each : found) each.space = spaces.of(grid, each.pocket.cells);
  return found;
}

double correction_of_volume(double displacement, double spacing) {
  return 1.0 - std::exp(-displacement / (relaxation_distance * spacing));
}

void take_over(std::vector<FoundPocket> found, std::span<const double> volumes, double pace, const GasLaw& law,
               AirState& state) {
  state.pockets.clear();
  for (std::size_t k = 0; k < found.size(); ++k) {
    AirPocket& pocket = found[k].pocket;
    const double shut_in = std::max(0.0, found[k].new_share * volumes[k]);
    pocket.gas += shut_in;
    pocket.volume += shut_in;
    state.gas_found += shut_in;
    TAILWATER_ASSERT(pocket.volume > 0.0, "a pocket has a volume");
    if (pocket.torn == 0.0 && !found[k].keeps_volume) {
      const double before = law.energy(pocket.gas, pocket.volume);
      pocket.volume += pace * (volumes[k] - pocket.volume);
      state.energy_set += law.energy(pocket.gas, pocket.volume) - before;
    }
    state.pockets.push_back(std::move(pocket));
  }
  state.displacement = 0.0;
}

TAILWATER_IN_2D_AND_3D(follow_pockets);

}  // namespace tailwater
