// Walls in the viscous forces of a thick liquid (viscous_operator.h): their motion, and pairs of fluid with them.
#pragma once

#include <algorithm>
#include <vector>

#include "flow/flow.h"
#include "walls/wall_friction.h"

namespace tailwater {

/// The rigid motion of the walls.
template <int Dim>
struct WallRates {
  std::vector<Vec<Dim>> velocity;  ///< m/s; of each row of walls that move
  std::vector<Mat<Dim>> spin;      ///< 1/s; of each wall, whose velocity changes by spin d over a way d; empty: all 0

  /// The velocity [m/s] that the wall of a row has by its rigid motion at `d` [m] from the row.
  Vec<Dim> at(const Walls<Dim>& walls, std::int32_t row, const Vec<Dim>& d) const {
    const Vec<Dim> own = entry_of<Dim>(velocity, row);
    return spin.empty() ? own : Vec<Dim>(own + spin[walls.particles.wall[row]] * d);
  }
};

/// Distance [m] of the fluid particle in front of the wall; `d` leads from the particle of row `row` to the fluid.
template <int Dim>
double distance_from_wall(const Flow<Dim>& flow, std::int32_t row, const Vec<Dim>& d) {
  return std::max(d.dot(flow.walls.particles.normal[row]) - flow.walls.depth[row],
                  min_friction_distance * flow.setup.scale.spacing);
}

/// The projector on the directions along the wall.
template <int Dim>
Mat<Dim> along_wall(const Flow<Dim>& flow, std::int32_t row) {
  const Vec<Dim>& n = flow.walls.particles.normal[row];
  return Mat<Dim>::Identity() - n * n.transpose();
}

/// 2 (1 + b) F [1/m^(Dim+2)] of the pair, in the row of either particle.
template <int Dim>
double wall_factor(const Flow<Dim>& flow, std::int32_t row, const Vec<Dim>& d, double F) {
  return 2.0 * (1.0 + flow.walls.depth[row] / distance_from_wall(flow, row, d)) * F;
}

}  // namespace tailwater
