// Pockets of air over time: which part of the void is which pocket, when one begins and ends, and what becomes of its
// gas.
#pragma once

#include <cstdint>
#include <vector>

#include "air/gas_law.h"
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
  std::int64_t begun = 0;
  std::int64_t ended = 0;
  double displacement = 0.0;   ///< m; how far water may have gone since pockets were looked for
  double gas_found = 0.0;      ///< m^Dim; of all that have begun, at the pressure of the atmosphere
  double gas_lost = 0.0;       ///< m^Dim; of all that have ended
  double gas_vented = 0.0;     ///< m^Dim; that has left through vents, less what came in
  double energy_lost = 0.0;    ///< J; of the gas of those that have ended
  double energy_vented = 0.0;  ///< J; that was lost in vents
  double energy_set = 0.0;     ///< J; that the gas got where the volume was set right by what the cells tell
};

/// What a look at the void has found of one pocket.
struct FoundPocket {
  AirPocket pocket;
  double new_share = 0.0;  ///< of its cells that no pocket had: 1 where it has just been shut in
};

/// The pockets of this moment, from those at the last look, since which water may have gone `displacement` [m]. Volumes
/// and gas are those of the old ones: cells that one of them had take along their share of both, so gas is kept where
/// pockets join and part. A part of the void that reaches the open is no pocket; cells that a pocket had are one on
/// their own for a while, as a film of water that tears for a few steps lets out no gas. What ends is counted in
/// `state`.
template <int Dim>
std::vector<FoundPocket> follow_pockets(const VoidGrid<Dim>& grid, double spacing, const Voids<Dim>& voids,
                                        const GasLaw& law, AirState& state);

/// Takes over the pockets with the volumes that the cells tell of them. That is the volume of one that begins; of
/// others it sets the volume right little by little, as water goes `displacement` [m].
void take_over(std::vector<FoundPocket> found, std::span<const double> volumes, double spacing, const GasLaw& law,
               AirState& state);

}  // namespace tailwater
