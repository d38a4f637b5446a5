// The forces of the water on the walls during one step, by the particles through which they act.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// Entries of owned particles. On a wall particle: what its pairs with fluid particles do to it. On a fluid particle:
/// what it does to the wall in front of which the last guard has kept it. Their sum is what the walls have taken from
/// the water's momentum, per time. In 2D per metre of width.
template <int Dim>
struct WallForces {
  std::vector<Vec<Dim>> pressure;  ///< N
  std::vector<Vec<Dim>> friction;  ///< N

  void reset(std::size_t owned) {
    pressure.assign(owned, Vec<Dim>::Zero());
    friction.assign(owned, Vec<Dim>::Zero());
  }
};

}  // namespace tailwater
