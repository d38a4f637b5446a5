// Walls without thickness: water on one side does not feel the water on the other. The wall particles of a plate stand
// on both of its sides. A particle of the water feels exactly those that the plate hides from it: they replace the
// water behind the plate, so that the support is filled once, also beside the end of a plate. The same holds for the
// particles of other walls beside their free ends. Beside the rim of a wall the pairs fade (geometry/screen.h).
#pragma once

#include <vector>

#include "neighbours/neighbourhood.h"
#include "particles/particles.h"
#include "walls/wall_model.h"

namespace tailwater {

/// How water feels each particle, as in visible_fraction; empty if there are no screens.
template <int Dim>
std::vector<int> find_felt_through(const Walls<Dim>& walls, const Particles<Dim>& particles);

/// Weights the pairs near screens by their visible fraction. Call after each Neighbourhood::update.
template <int Dim>
void hide_pairs_behind_screens(const Walls<Dim>& walls, const Particles<Dim>& particles,
                               Neighbourhood<Dim>& neighbourhood);

}  // namespace tailwater
