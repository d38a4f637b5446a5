// A row of particles on the wall, which have the fluid's own pressure equation, and dummies behind, each with the
// pressure of the row beside it, p_d = sum_w W p_w/sum_w W, so that nothing flows across the wall (Neumann); as
// published by Farmani et al. (2020). Gravity and the wall's own motion act in the prediction.
#pragma once

#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_row_and_dummies();

}  // namespace tailwater
