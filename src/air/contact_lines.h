// Forces on walls at contact lines, where the surface of water under air at a pressure P meets a wall. The pairs of a
// wall particle there have water on one side only, so the half of their force that acts through it pushes the wall
// along itself: 0.28 dx P per length of the line. Walls take pressure along their normal only. On the water this force
// stands for the push of the air on a strip beside the wall.
#pragma once

#include "air/enclosed_air.h"

namespace tailwater {

/// Takes the force along the walls that a uniform pressure of the pockets causes from the forces on the walls in this
/// step, if a probe needs them. It is 0 where water, or water and walls, are on all sides. Collective.
template <int Dim>
void remove_push_along_walls(Flow<Dim>& flow, const PocketStep<Dim>& step);

}  // namespace tailwater
