// The forces of the water on the walls during one step, by the particles through which they act.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// Pressure force on a hull, a floating body or a wall that water surrounds, beside another wall, where the forces of
/// pairs are incomplete.
template <int Dim>
struct ForceBesideWall {
  std::vector<int> walls;  ///< of the hull, indices into Boundary::walls
  int beside;              ///< the nearest other wall
  Vec<Dim> centre;
  Vec<Dim> force;                ///< N
  Vec<Dim == 2 ? 1 : 3> moment;  ///< N m; about the centre
};

/// Fraction of a pair's force that acts through its fluid particle; along the normal of a wall in a narrow gap it is 0.
inline constexpr double share_of_water = 0.5;

/// Forces between water and walls, one entry per owned particle. Entry of a wall particle: the force of its pairs with
/// fluid particles, without the part of the pressure that acts through the fluid particles. Entry of a fluid particle:
/// that part for its own pairs, and the reaction of the last guard that kept it in front of a wall. The sum of all
/// entries is the momentum per time that the walls have taken from the water, up to the balanced pressure and the
/// errors of its pairs. In 2D per metre of width.
template <int Dim>
struct WallForces {
  std::vector<Vec<Dim>> pressure;       ///< N; on a fluid particle the reaction of the guard
  std::vector<Vec<Dim>> through_water;  ///< N; pressure through a fluid particle, 0 on a wall particle
  std::vector<Vec<Dim>> friction;       ///< N
  /// N; of the pairs of the balanced pressure. On walls without such patches as below they are forces too. Empty if all
  /// walls have such patches, or none.
  std::vector<Vec<Dim>> of_balanced;
  std::vector<ForceBesideWall<Dim>> beside_walls;  ///< identical on all ranks
  /// Pa; of each patch of the walls, the pressure that balances the weight and is not in the other forces
  /// (pressure/balanced_on_walls.h). Empty: none. Identical on all ranks.
  std::vector<double> balanced;
  bool are_requested = false;          ///< whether a probe or a part needs friction and the guard's forces
  bool pressure_is_requested = false;  ///< whether a probe needs the pressure forces too

  void reset(std::size_t owned) {
    pressure.assign(owned, Vec<Dim>::Zero());
    through_water.assign(owned, Vec<Dim>::Zero());
    friction.assign(owned, Vec<Dim>::Zero());
    of_balanced.clear();
    beside_walls.clear();
    balanced.clear();
  }
};

}  // namespace tailwater
