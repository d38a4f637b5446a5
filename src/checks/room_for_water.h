// The space that moving walls leave to the water.
#pragma once

#include <optional>
#include <vector>

#include "case/spec.h"
#include "checks/cell_space.h"
#include "geometry/boundary.h"
#include "motion/wall_motion.h"
#include "sampling/fluid_particles.h"

namespace tailwater {

template <int Dim>
class RoomForWater {
 public:
  RoomForWater(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid);

  double water() const { return water_; }  ///< m^Dim

  /// Moves the walls, each face by its map `displacement`. Cells that a face has passed over no longer hold water.
  void move(std::vector<WallFace<Dim>> faces, const std::vector<AffineMap<Dim>>& displacement);

  struct Enclosed {
    double volume;            ///< m^Dim, upper bound
    std::vector<bool> walls;  ///< by face: whether it holds the water
  };
  /// Empty if the water can get out.
  std::optional<Enclosed> enclosed() const;

 private:
  CellSpace<Dim> space_;
  double water_;
  std::vector<typename CellSpace<Dim>::Cell> wet_;
};

}  // namespace tailwater
