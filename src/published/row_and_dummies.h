// A row of particles on the wall, with dummies behind it, as published by Farmani et al. (2020). The particles on the
// wall have the fluid's pressure equation. Each dummy takes the pressure of the row beside it,
// p_d = sum_w W p_w/sum_w W, so that nothing flows across the wall (Neumann). Gravity and the wall's own motion act in
// the prediction.
#pragma once

#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_row_and_dummies();

}  // namespace tailwater
