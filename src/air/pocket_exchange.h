// Gas of sealed spaces passes only between their pockets:
//
//   a pocket that ends leaves its gas and volume to the nearest pocket of its space;
//   a pocket that begins takes gas with its volume from the nearest pocket of its space;
//   the volume of a pocket is corrected with gas from or to the largest pocket of its space.
//
// Gas always takes along the volume that it has in its former pocket, so gas and volume of a space are conserved. Its
// energy, which is convex and homogeneous in (G, V), never rises.
#pragma once

#include <span>
#include <vector>

#include "air/pockets.h"
#include "air/sealed_spaces.h"

namespace tailwater {

/// The exchange after a search for pockets; `begun_before` pockets had begun before it. `volumes` are those of their
/// cells, to which the volume of a pocket that continues is corrected by the fraction `pace`. Gas without a pocket in
/// its space stays in `state.hidden`; gas that is no longer in any sealed space is lost.
template <int Dim>
void exchange_gas(const VoidGrid<Dim>& grid, const SealedSpaces<Dim>& spaces, std::span<const double> volumes,
                  std::int64_t begun_before, double pace, const GasLaw& law, std::vector<FoundPocket>& found,
                  AirState& state);

/// By pocket the largest pocket of its sealed space, as an index; -1: it is in none.
std::vector<int> largest_of_space(std::span<const FoundPocket> found);

}  // namespace tailwater
