// Gas of sealed spaces passes from pocket to pocket, and nowhere else:
//
//   a pocket that ends leaves its gas and volume to the nearest pocket of its space;
//   a pocket that begins takes gas with its volume from the nearest pocket of its space;
//   the volume of a pocket is corrected with gas from or to the largest pocket of its space.
//
// Gas always takes along the volume that it has where it comes from, so gas and volume of a space are conserved, and
// its energy never rises: it is convex and homogeneous in (G, V).
#pragma once

#include <span>
#include <vector>

#include "air/pockets.h"
#include "air/sealed_spaces.h"

namespace tailwater {

/// The exchange after a look for pockets that began when `begun_before` had begun. `volumes` are those of their cells,
/// to which the volume of a pocket that continues is corrected by the fraction `pace`. Gas without a pocket in its
/// space stays in `state.hidden`; gas that is in no sealed space any more is lost.
template <int Dim>
void exchange_gas(const VoidGrid<Dim>& grid, const SealedSpaces<Dim>& spaces, std::span<const double> volumes,
                  std::int64_t begun_before, double pace, const GasLaw& law, std::vector<FoundPocket>& found,
                  AirState& state);

/// By pocket the largest one of its sealed space, as an index; -1: it is in none.
std::vector<int> largest_of_space(std::span<const FoundPocket> found);

}  // namespace tailwater
