// Pockets of air over time: which part of the void is which pocket, when one begins and ends, and what becomes of its
// gas.
#pragma once

#include <cstdint>
#include <vector>

#include "air/gas_law.h"
#include "air/sealed_spaces.h"
#include "air/voids.h"

namespace tailwater {

struct AirPocket {
  std::int64_t number = 0;  ///< counts all that have begun
  double gas = 0.0;         ///< m^Dim; the volume that its gas would have at the pressure of the atmosphere
  double volume = 0.0;      ///< m^Dim
  double torn = 0.0;        ///< m; how far water may have gone since air of the open reached it; 0: it is closed
  std::vector<CellRun> cells;
};

/// What is remembered of the air; the same on all ranks. A part of the state of a flow.
struct AirState {
  std::vector<AirPocket> pockets;
  std::vector<AirPocket> hidden;  ///< of sealed spaces: gas of pockets that have ended, until there is one again
  std::int64_t begun = 0;
  std::int64_t ended = 0;
  std::vector<double> brought;  ///< m^Dim; that each open end has brought, as the pockets know it; empty before a step
  double displacement = 0.0;    ///< m; how far water may have gone since pockets were looked for
  double gas_found = 0.0;       ///< m^Dim; of all that have begun, at the pressure of the atmosphere
  double gas_lost = 0.0;        ///< m^Dim; of all that have ended, and went to the atmosphere
  double gas_handed_on = 0.0;   ///< m^Dim; of all that have ended in sealed spaces, and went to other pockets
  double gas_vented = 0.0;      ///< m^Dim; that has left through vents, less what came in
  double energy_lost = 0.0;     ///< J; of the gas of those that have ended, and where gas has mixed
  double energy_vented = 0.0;   ///< J; that was lost in vents
  double energy_set = 0.0;      ///< J; that the gas got where the volume was set right by what the cells tell

  double brought_before(std::size_t end) const { return end < brought.size() ? brought[end] : 0.0; }
};

/// What a look at the void has found of one pocket.
struct FoundPocket {
  AirPocket pocket;
  double new_share = 0.0;     ///< of its cells that no pocket had: 1 where it has just been shut in
  int space = -1;             ///< the sealed space that it is in; -1: it is in none
  bool keeps_volume = false;  ///< whether exchange_gas has set its volume
};

/// The pockets of this moment, from those at the last look, since which water may have gone `displacement` [m]. Volumes
/// and gas are those of the old ones: cells that one of them had take along their share of both, so gas is kept where
/// pockets join and part. A part of the void that reaches the open is no pocket; cells that a pocket had are one on
/// their own for a while, as a film of water that tears for a few steps lets out no gas. What ends in a sealed space
/// becomes hidden; what ends elsewhere is counted in `state`.
template <int Dim>
std::vector<FoundPocket> follow_pockets(const VoidGrid<Dim>& grid, double spacing, const Voids<Dim>& voids,
                                        const SealedSpaces<Dim>& spaces, const GasLaw& law, AirState& state);

/// The fraction by which the volume of a pocket approaches that of its cells, as water goes `displacement` [m].
double correction_of_volume(double displacement, double spacing);

/// Takes over the pockets with the volumes that the cells tell of them. That is the volume of one that begins; of
/// others it sets the volume right by `pace`, but of those in sealed spaces, whose volumes exchange_gas has set.
void take_over(std::vector<FoundPocket> found, std::span<const double> volumes, double pace, const GasLaw& law,
               AirState& state);

}  // namespace tailwater
