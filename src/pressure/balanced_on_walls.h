// The force on walls of the pressure q that balances the weight of water (flow/balanced_pressure.h). Pairs have p - q,
// so the force of q is its integral over the part of the walls that water wets. Below the level of q all space between
// walls is water or dry, so a patch of a wall is wet if a fluid particle is close in front of it.
#pragma once

#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// q [Pa] at the centre of each wet patch of Walls::patches, 0 on dry ones; empty where there is none. The same on all
/// ranks. Collective.
template <int Dim>
std::vector<double> balanced_on_walls(const Flow<Dim>& flow);

/// q [Pa] at all particles.
template <int Dim>
std::vector<double> balanced_at_particles(const Flow<Dim>& flow);

}  // namespace tailwater
