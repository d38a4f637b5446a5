// The forces of the water on the walls during one step, by the particles through which they act.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// The force of the pressure that moves a floating body beside another wall, where pairs do not give all of it.
template <int Dim>
struct ForceBesideWall {
  int body;
  int beside;  ///< the nearest other wall, an index into Boundary::walls
  Vec<Dim> centre;
  Vec<Dim> force;                ///< N
  Vec<Dim == 2 ? 1 : 3> moment;  ///< N m; about the centre
};

/// Entries of owned particles. On a wall particle: what its pairs with fluid particles do to it, of the pressure that
/// part of it which does not act through the fluid particles. On a fluid particle: that part of its own pairs, and what
/// it does to the wall in front of which the last guard has kept it. The sum of all is what the walls have taken from
/// the water's momentum, per time. In 2D per metre of width.
template <int Dim>
struct WallForces {
  std::vector<Vec<Dim>> pressure;                  ///< N; on a fluid particle the guard's
  std::vector<Vec<Dim>> through_water;             ///< N; pressure through a fluid particle, 0 on a wall particle
  std::vector<Vec<Dim>> friction;                  ///< N
  std::vector<ForceBesideWall<Dim>> beside_walls;  ///< the same on all ranks
  bool are_requested = false;                      ///< whether a probe or a part needs friction and the guard's forces
  bool pressure_is_requested = false;              ///< whether a probe needs the forces of the pressure too

  void reset(std::size_t owned) {
    pressure.assign(owned, Vec<Dim>::Zero());
    through_water.assign(owned, Vec<Dim>::Zero());
    friction.assign(owned, Vec<Dim>::Zero());
    beside_walls.clear();
  }
};

}  // namespace tailwater
