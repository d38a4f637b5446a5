// Pockets of air over time: which part of the void belongs to which pocket, the begin and end of a pocket, and the fate
// of its gas.
#pragma once

#include <cstdint>
#include <vector>

#include "air/gas_law.h"
#include "air/sealed_spaces.h"
#include "air/voids.h"

namespace tailwater {

struct AirPocket {
  std::int64_t number = 0;  ///< consecutive, over all that have begun
  double gas = 0.0;         ///< m^Dim; the volume that its gas would have at the pressure of the atmosphere
  double volume = 0.0;      ///< m^Dim
  double torn = 0.0;        ///< m; how far water may have gone since open air reached it; 0: it is closed
  std::vector<CellRun> cells;
};

/// The state of the air between steps; the same on all ranks. A part of the state of a flow.
struct AirState {
  std::vector<AirPocket> pockets;
  std::vector<AirPocket> hidden;  ///< in sealed spaces: gas of pockets that have ended, until there is a pocket again
  std::int64_t begun = 0;
  std::int64_t ended = 0;
  std::vector<double> brought;  ///< m^Dim; volume of each open end that the pockets have included; empty before a step
  double displacement = 0.0;    ///< m; how far water may have gone since the last search for pockets
  double gas_found = 0.0;       ///< m^Dim; gas of all that have begun, at the pressure of the atmosphere
  double gas_lost = 0.0;        ///< m^Dim; gas of all that have ended, and went to the atmosphere
  double gas_handed_on = 0.0;   ///< m^Dim; gas of all that have ended in sealed spaces, and went to other pockets
  double gas_vented = 0.0;      ///< m^Dim; gas that has left through vents, less gas that came in
  double energy_lost = 0.0;     ///< J; of the gas of those that have ended, and by mixing of gas
  double energy_vented = 0.0;   ///< J; energy lost in vents
  double energy_set = 0.0;      ///< J; energy that the gas got by corrections of the volume to that of the cells

  double brought_before(std::size_t end) const { return end < brought.size() ? brought[end] : 0.0; }
};

/// A pocket that a search of the void has found.
struct FoundPocket {
  AirPocket pocket;
  double new_share = 0.0;     ///< fraction of its cells that no pocket had: 1 where it has just been enclosed
  int space = -1;             ///< index of its sealed space; -1: it is in none
  bool keeps_volume = false;  ///< whether exchange_gas has set its volume
};

/// The present pockets, from those at the last search, since which water may have gone `displacement` [m]. Volumes and
/// gas are those of the old pockets: cells of an old pocket carry their fraction of both, so gas is conserved where
/// pockets join and part. A part of the void that reaches the open air is no pocket. Cells in it that belonged to a
/// pocket remain a pocket for a while, because a film of water that tears for a few steps lets no gas escape. The gas
/// of a pocket that ends in a sealed space becomes hidden; otherwise it is counted in `state`.
template <int Dim>
std::vector<FoundPocket> follow_pockets(const VoidGrid<Dim>& grid, double spacing, const Voids<Dim>& voids,
                                        const SealedSpaces<Dim>& spaces, const GasLaw& law, AirState& state);

/// The fraction by which the volume of a pocket approaches that of its cells, as water goes `displacement` [m].
double correction_of_volume(double displacement, double spacing);

/// Adopts the pockets, with the volumes of their cells. A pocket that begins has this volume. The volume of others is
/// corrected by `pace`, except in sealed spaces, where exchange_gas has set it.
void take_over(std::vector<FoundPocket> found, std::span<const double> volumes, double pace, const GasLaw& law,
               AirState& state);

}  // namespace tailwater
