// One row of particles on the wall itself, as published (F36)-(F39). Each particle's equation prescribes the consistent
// gradient along the normal, grad p . n = rho (g - a) . n. Needs the renormalisation tensors.
#pragma once

#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_pressure_rows();

}  // namespace tailwater
