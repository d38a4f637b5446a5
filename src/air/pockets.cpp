#include "air/pockets.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/assert.h"

namespace tailwater {
namespace {

/// [dx]; edge of the void, without the cells near water, from which on air that is shut in is a pocket, and below which
/// a pocket is none any more.
constexpr double least_at_begin = 2.0;
constexpr double least = 1.0;

/// [dx]; how far water may go until the gas of a pocket that has become open is gone.
constexpr double distance_until_gone = 2.0;

/// [dx]; how far water goes while the volume comes near that of the cells (by 1/e). Long beside a pulsation, so that
/// only what adds up is taken out.
constexpr double relaxation_distance = 50.0;

/// Share of the cells of a pocket that none had from which on it has not moved there: air was shut in beside it.
constexpr double shut_in_share = 0.5;

/// The cells that a pocket had and that are void now: how many are in which part, and the pieces in the open.
struct Overlap {
  std::map<int, std::int64_t> closed;  ///< cells by part
  std::vector<CellRun> in_the_open;
  std::int64_t cells_in_the_open = 0;
  std::int64_t all = 0;
};

template <int Dim>
Overlap overlap_of(const AirPocket& pocket, const VoidGrid<Dim>& grid, const Voids<Dim>& voids) {
  Overlap overlap;
  for (const CellRun& run : pocket.cells) {
    if (run.row < 0 || run.row >= grid.rows()) continue;  // a checkpoint may say anything
    voids.visit_pieces(run, [&](const CellRun& piece, int part) {
      overlap.all += piece.cells();
      if (voids.parts()[part].is_open) {
        overlap.in_the_open.push_back(piece);
        overlap.cells_in_the_open += piece.cells();
      } else {
        overlap.closed[part] += piece.cells();
      }
    });
  }
  return overlap;
}

void count_end(const AirPocket& pocket, double share, const GasLaw& law, AirState& state) {
  if (share <= 0.0) return;
  state.gas_lost += share * pocket.gas;
  state.energy_lost += share * law.energy(pocket.gas, pocket.volume);
}

/// What is found of one part of the void, while old pockets bring their shares.
struct Gathered {
  FoundPocket found;
  std::int64_t old_cells = 0;
  std::int64_t most = 0;  ///< cells from the pocket whose number it has
};

void bring(const AirPocket& old, double share, std::int64_t cells, Gathered& to) {
  AirPocket& pocket = to.found.pocket;
  pocket.gas += share * old.gas;
  pocket.volume += share * old.volume;
  to.old_cells += cells;
  if (cells > to.most) {
    to.most = cells;
    pocket.number = old.number;
  }
}

/// Of two that have the number of one pocket, which has parted, the later gets a new one.
void renumber_split_pockets(std::vector<FoundPocket>& found, AirState& state) {
  for (std::size_t a = 0; a < found.size(); ++a) {
    const auto has_same = [&](const FoundPocket& other) { return other.pocket.number == found[a].pocket.number; };
    const bool is_taken = std::any_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(a), has_same);
    if (found[a].pocket.number < 0 || is_taken) found[a].pocket.number = state.begun++;
  }
}

}  // namespace

template <int Dim>
std::vector<FoundPocket> follow_pockets(const VoidGrid<Dim>& grid, double spacing, const Voids<Dim>& voids,
                                        const GasLaw& law, AirState& state) {
  const auto cells_of = [&](double edge) { return power<Dim>(edge * spacing) / grid.cell_volume(); };
  std::map<int, Gathered> parts;  // those that are pockets
  for (std::size_t p = 0; p < voids.parts().size(); ++p) {
    const auto& part = voids.parts()[p];
    if (part.is_open || !part.touches_water || static_cast<double>(part.cells) < cells_of(least)) continue;
    parts[static_cast<int>(p)].found.pocket.number = -1;
  }
  std::vector<FoundPocket> torn;
  for (const AirPocket& old : state.pockets) {
    Overlap overlap = overlap_of(old, grid, voids);
    double lost = 1.0;
    for (const auto& [part, cells] : overlap.closed) {
      const auto gathered = parts.find(part);
      if (gathered == parts.end()) continue;
      const double share = static_cast<double>(cells) / static_cast<double>(overlap.all);
      bring(old, share, cells, gathered->second);
      lost -= share;
    }
    const double since_torn = old.torn + state.displacement;
    const auto torn_cells = static_cast<double>(overlap.cells_in_the_open);
    if (torn_cells >= cells_of(least) && since_torn < distance_until_gone * spacing) {
      const double share = torn_cells / static_cast<double>(overlap.all);
      torn.push_back(
          {{old.number, share * old.gas, share * old.volume, since_torn, std::move(overlap.in_the_open)}, 0.0});
      lost -= share;
    }
    if (lost > 1e-12) count_end(old, lost, law, state);
    if (lost > 1.0 - 1e-12) ++state.ended;
  }
  for (std::size_t k = 0; k < voids.runs().size(); ++k) {
    const auto gathered = parts.find(voids.part_of(k));
    if (gathered != parts.end()) gathered->second.found.pocket.cells.push_back(voids.runs()[k]);
  }
  std::vector<FoundPocket> found;
  for (auto& [p, gathered] : parts) {
    const auto cells = static_cast<double>(voids.parts()[p].cells);
    if (gathered.old_cells == 0 && cells < cells_of(least_at_begin)) continue;
    const double is_new = 1.0 - static_cast<double>(gathered.old_cells) / cells;
    const bool has_shut_in = is_new > shut_in_share && is_new * cells >= cells_of(least_at_begin);
    gathered.found.new_share = has_shut_in ? is_new : 0.0;
    found.push_back(std::move(gathered.found));
  }
  std::ranges::move(torn, std::back_inserter(found));
  renumber_split_pockets(found, state);
  return found;
}

void take_over(std::vector<FoundPocket> found, std::span<const double> volumes, double spacing, const GasLaw& law,
               AirState& state) {
  const double pace = 1.0 - std::exp(-state.displacement / (relaxation_distance * spacing));
  state.pockets.clear();
  for (std::size_t k = 0; k < found.size(); ++k) {
    AirPocket& pocket = found[k].pocket;
    const double shut_in = std::max(0.0, found[k].new_share * volumes[k]);
    pocket.gas += shut_in;
    pocket.volume += shut_in;
    state.gas_found += shut_in;
    TAILWATER_ASSERT(pocket.volume > 0.0, "a pocket has a volume");
    if (pocket.torn == 0.0) {
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
