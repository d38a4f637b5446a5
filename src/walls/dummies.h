// Dummy particles behind the wall, mirror images of the water (after Adami, Hu & Adams 2012):
//
//   velocity   u_w = V + (I - 2 M) (mean_w - V): the normal part is reversed, the tangential part kept. This is free
//              slip, whatever the friction: the divergence is that of water gliding past a boundary layer thinner than
//              dx. Friction is a separate stress (wall_friction.h). A no-slip image would give the divergence of water
//              that turns back inside the wall.
//   row        p_w = sum_f W (p_f + rho (g - a) . r_wf)/sum_f W. All weights have one sign, so the whole matrix stays
//              an M-matrix
//   pressure   never below 0 where there is air: dummies do not pull
//
// V is the wall's own velocity, M the projector onto the directions the wall blocks, mean_w the Shepard mean of the
// fluid in reach.
#pragma once

#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_dummies();

}  // namespace tailwater
