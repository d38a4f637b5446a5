// The water balance of a run: start + in = inside + outside + out. Outside is water that has left the walls over a rim;
// out is water that has left through an open end, and in is water that has come through one.
#pragma once

#include <string>

#include "base/json.h"
#include "flow/flow.h"
#include "flow/water_amount.h"

namespace tailwater {

/// "50 particles (0.5 m^3)".
std::string text_of(const WaterAmount& water);

/// All water that is computed, over all ranks; energies are not counted, here and below. Collective.
template <int Dim>
WaterAmount water_in(const Flow<Dim>& flow);

/// The water that has left the walls for good, over all ranks. Such water is beyond the box around walls and open ends,
/// and no wall straight below it, along gravity, would catch it. Water that has fallen below all walls counts too,
/// although it is no longer computed. Spray above an open tank is not lost, and neither is water on its way out through
/// an open end. Collective.
template <int Dim>
WaterAmount water_outside(const Flow<Dim>& flow);

/// m; of the first particle, by id, of the water outside that is computed. There must be some. Collective.
template <int Dim>
Vec<Dim> place_of_water_outside(const Flow<Dim>& flow);

/// The water that is computed and not outside; collective.
template <int Dim>
WaterAmount water_inside(const Flow<Dim>& flow);

/// Block "water_balance" of the summary; collective.
template <int Dim>
Json water_balance(const WaterAmount& at_start, const Flow<Dim>& flow);

}  // namespace tailwater
