// The force of the pressure q that balances the weight of water (flow/balanced_pressure.h) on walls that are wet
// everywhere below its level, on one side or, for plates, on both, except where other walls cover them. Pairs have
// p - q there, and the force of q is its integral over the walls. On other walls, such as a tank on one side of a dam,
// the force is that of the pairs of p: the border between their wet and dry parts is not known to less than a spacing.
#pragma once

#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// q [Pa] at the centre of the wet part of each patch of Walls::patches on such walls, 0 on others; empty where there
/// is none. The same on all ranks. Places the patches. Collective.
template <int Dim>
std::vector<double> balanced_on_walls(Flow<Dim>& flow);

/// Whether each wall has a force of q in the present forces.
template <int Dim>
std::vector<bool> walls_with_balanced(const Flow<Dim>& flow);

}  // namespace tailwater
