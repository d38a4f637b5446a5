// Friction of walls on the water beside them: the viscous stress of the no-slip condition, and the excess by the wall
// law of a turbulent layer (closures/wall_law.h).
#pragma once

#include <span>
#include <vector>

#include "base/vec.h"
#include "walls/friction_law.h"
#include "walls/walls.h"

namespace tailwater {

/// [dx]; least distance from a wall with friction: nearer water counts as this far away, because particles keep no
/// nearer.
inline constexpr double min_friction_distance = 0.25;

/// Properties of the walls with friction in reach of a fluid particle: weighted means over their particles.
template <int Dim>
struct FrictionWall {
  double weight = 0.0;                        ///< 1/m^2; sum of lambda c_iw; 0: no such wall
  Vec<Dim> slip_velocity = Vec<Dim>::Zero();  ///< m/s; the water's velocity along the wall, relative to it
  double distance = 0.0;                      ///< m; at least `min_friction_distance`
  double roughness = 0.0;                     ///< m; k_s
  double friction_velocity = 0.0;             ///< m/s; u_tau of the larger of the two laws
  double excess = 0.0;  ///< m^2/s^2; excess of the turbulent stress over the laminar one, divided by rho
  bool is_turbulent() const { return excess > 0.0; }
};

/// The friction walls of each owned particle; the weight of wall particles is 0. `V` is the wall's velocity for each
/// row of its table; `velocity` is the water's.
template <int Dim>
std::vector<FrictionWall<Dim>> find_friction_walls(const WallScene<Dim>& scene, const FrictionLaw& law,
                                                   std::span<const Vec<Dim>> V, std::span<const Vec<Dim>> velocity);

/// Adds lambda times the stress of `walls` to the acceleration [m/s^2] of fluid particles: the tangential part of
/// sum_w lambda c_iw [nu (u_noslip - u_i) - k_i (u_i - V)]. Here c_iw is the Morris weight, `no_slip` the wall model's
/// velocity for each wall particle (up to date on ghosts), and V the wall's velocity, on which the slip velocity
/// depends. k_i [m^2/s] makes the second term the excess of the turbulent stress; `excess_viscosity`, if it is not
/// empty, receives it for owned particles. Relative to the wall, friction only slows the water.
template <int Dim>
void add_wall_friction(const WallScene<Dim>& scene, const FrictionLaw& law, std::span<const FrictionWall<Dim>> walls,
                       std::span<const Vec<Dim>> no_slip, std::span<const Vec<Dim>> velocity,
                       std::span<Vec<Dim>> acceleration, std::span<double> excess_viscosity = {});

/// The opposite forces [N, divided by the density in kg/m^3] on owned wall particles, pair by pair. `excess_viscosity`
/// is the output of the function above, up to date on ghosts as `no_slip` and `velocity` are.
template <int Dim>
void find_friction_on_walls(const WallScene<Dim>& scene, const FrictionLaw& law, std::span<const Vec<Dim>> V,
                            std::span<const Vec<Dim>> no_slip, std::span<const Vec<Dim>> velocity,
                            std::span<const double> excess_viscosity, std::span<Vec<Dim>> force);

}  // namespace tailwater
