// Dummy particles behind the wall, mirror images of the water (after Adami, Hu & Adams 2012):
//
//   velocity   u_w = V + (I - 2 M) (mean_w - V): normal part reversed, tangential part kept, free slip for any
//              friction: the divergence is that of water that glides past a boundary layer thinner than dx, and
//              friction is a stress of its own (wall_friction.h). With the image of no slip the divergence along the
//              wall is that of water that turns back in it.
//   row        p_w = sum_f W (p_f + rho (g - a) . r_wf)/sum_f W, weights of one sign, so that the whole stays an
//              M-matrix
//   pressure   never below 0 where there is air: dummies do not pull
//
// V is the wall's own velocity, M the projector on the directions the wall blocks, mean_w the Shepard mean of the fluid
// in reach.
#pragma once

#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_dummies();

}  // namespace tailwater
