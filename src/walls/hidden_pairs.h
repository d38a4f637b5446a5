// Walls without thickness: water on one side does not interact with the water on the other. The wall particles of a
// plate stand on both of its sides. A water particle interacts exactly with those that the plate hides from it: they
// replace the water behind the plate, so that the support is filled once, also beside the end of a plate. The same
// holds for the particles of other walls beside their free ends. Beside the rim of a wall the weights of the pairs
// decrease to 0 (geometry/screen.h).
#pragma once

#include <vector>

#include "neighbours/neighbourhood.h"
#include "particles/particles.h"
#include "walls/wall_model.h"

namespace tailwater {

/// Visibility of each particle from water, as in visible_fraction; empty if there are no screens.
template <int Dim>
std::vector<int> find_felt_through(const Walls<Dim>& walls, const Particles<Dim>& particles);

/// Weights the pairs near screens by their visible fraction. Call after each Neighbourhood::update.
template <int Dim>
void hide_pairs_behind_screens(const Walls<Dim>& walls, const Particles<Dim>& particles,
                               Neighbourhood<Dim>& neighbourhood);

}  // namespace tailwater
