// The accelerations of a flow's walls for the probes.
#pragma once

#include <vector>

#include "flow/flow.h"
#include "neighbours/halo.h"
#include "particles/wall_inertia.h"

namespace tailwater {

/// Borrows the walls of a flow at the end of a step.
template <int Dim>
class InertiaOfWalls {
 public:
  /// Collective.
  explicit InertiaOfWalls(const Flow<Dim>& flow) {
    const Walls<Dim>& walls = flow.walls;
    exists_ = walls.is_curved || walls.moving > 0;  // the same on all ranks
    if (!exists_) return;
    turning_ = walls.turn_acceleration;
    flow.halo().exchange(turning_);
    inertia_ = {walls.particles.blocked, walls.acceleration, turning_};
  }
  InertiaOfWalls(const InertiaOfWalls&) = delete;
  InertiaOfWalls& operator=(const InertiaOfWalls&) = delete;

  /// Null where no wall accelerates the water beside it.
  const WallInertia<Dim>* get() const { return exists_ ? &inertia_ : nullptr; }

 private:
  bool exists_ = false;
  std::vector<Vec<Dim>> turning_;
  WallInertia<Dim> inertia_;
};

}  // namespace tailwater
