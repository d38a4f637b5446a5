// One row of particles on the wall itself, as published (F36)-(F39). Each particle's equation prescribes the consistent
// gradient along the normal, grad p . n = rho (g - a) . n. Needs the renormalisation tensors.
#pragma once

#include "published/renormalisation.h"
#include "walls/wall_model.h"

namespace tailwater {

/// `tensors` must be those of the particles at the present positions whenever rows are written.
template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_pressure_rows(std::shared_ptr<const Tensors<Dim>> tensors);

}  // namespace tailwater
