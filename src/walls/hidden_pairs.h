// Plates are walls without thickness: water on one side does not feel the water on the other. Two particles make a pair
// only if no plate is between them. The wall particles of a plate stand on both of its sides, and a particle of the
// water feels exactly those that the plate hides from it: they take the place of the water behind the plate, so that
// the support is filled once, also beside the end of a plate.
#pragma once

#include <vector>

#include "neighbours/neighbourhood.h"
#include "particles/particles.h"
#include "walls/wall_model.h"

namespace tailwater {

/// Of each particle, the plate that it is of, as an index into Boundary::walls, or -1; empty if there are no plates.
template <int Dim>
std::vector<int> plates_of_particles(const Walls<Dim>& walls, const Particles<Dim>& particles);

/// Takes out the pairs that plates hide. Call after each Neighbourhood::update.
template <int Dim>
void hide_pairs_behind_plates(const Walls<Dim>& walls, const Particles<Dim>& particles,
                              Neighbourhood<Dim>& neighbourhood);

}  // namespace tailwater
