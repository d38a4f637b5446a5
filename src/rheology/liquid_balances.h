// The balance of each of several liquids: amount, energy, and how far it has mixed with others.
#pragma once

#include <span>

#include "case/spec.h"
#include "flow/flow.h"

namespace tailwater {

/// One block per liquid, for the summary: particles, volume and mass, energies, the height of its centre against
/// gravity, and the fraction of its volume that is mixed: particles with more neighbours of other liquids than of their
/// own. Collective.
template <int Dim>
Json balances_of_liquids(const Flow<Dim>& flow, std::span<const LiquidTable> liquids);

}  // namespace tailwater
