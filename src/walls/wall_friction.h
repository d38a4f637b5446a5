// The friction of walls on the water beside them.
#pragma once

#include <span>

#include "closures/viscosity.h"
#include "walls/wall_model.h"

namespace tailwater {

/// Adds to the acceleration [m/s^2] of fluid particles lambda times the no-slip stress of the wall law: the tangential
/// part of sum_w lambda c_iw nu_wall(|u_i|) (u_noslip - u_i), where c_iw is the Morris weight and `no_slip` what the
/// wall model says for each wall particle (up to date on ghosts); the speed is relative to the wall, which moves at `V`
/// by row of its table. Only slows down, relative to the wall.
template <int Dim>
void add_wall_friction(const WallScene<Dim>& scene, const ViscosityLaw& law, double spacing,
                       std::span<const Vec<Dim>> V, std::span<const Vec<Dim>> no_slip,
                       std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration);

}  // namespace tailwater
