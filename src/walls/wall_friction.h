// The friction of walls on the water beside them.
#pragma once

#include <span>

#include "closures/viscosity.h"
#include "walls/wall_model.h"

namespace tailwater {

/// Adds lambda times the no-slip stress of the wall law to the acceleration [m/s^2] of fluid particles: the tangential
/// part of sum_w lambda c_iw nu_wall(|u_i|) (u_noslip - u_i). Here c_iw is the Morris weight, |u_i| the speed relative
/// to the wall, `no_slip` the wall model's velocity for each wall particle (up to date on ghosts), and `V` the wall's
/// velocity for each row of its table. Relative to the wall, it only slows the water. `wall_viscosity`, if it is not
/// empty, receives nu_wall(|u_i|) [m^2/s] of owned particles; 0 for those without friction.
template <int Dim>
void add_wall_friction(const WallScene<Dim>& scene, const ViscosityLaw& law, double spacing,
                       std::span<const Vec<Dim>> V, std::span<const Vec<Dim>> no_slip,
                       std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration,
                       std::span<double> wall_viscosity = {});

/// The opposite forces [N, divided by the density in kg/m^3] on owned wall particles, pair by pair. `wall_viscosity` is
/// what the function above gives, up to date on ghosts as `no_slip` and `velocity` are.
template <int Dim>
void find_friction_on_walls(const WallScene<Dim>& scene, double spacing, std::span<const Vec<Dim>> no_slip,
                            std::span<const Vec<Dim>> velocity, std::span<const double> wall_viscosity,
                            std::span<Vec<Dim>> force);

}  // namespace tailwater
