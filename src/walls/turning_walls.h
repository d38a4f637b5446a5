// Walls that change direction while water moves along them, at mid-step: curved walls and rotating walls
// (docs/theory/moving_walls.md#walls-at-mid-step). In a step, water moves along a chord of such a wall, tangential to
// it at mid-step. At the start of the step its velocity into the wall is therefore not that of the wall, but
//
//   n . (u - V) = -c,   c = t . (dt/2 S t + (Q - I) n),   t = (I - M) (u - V)
//
//   V, n, M  velocity, normal and blocked directions of the wall
//   S        its curvature: the normal turns by S d over a distance d along the wall
//   Q        its rotation in the step
//
// At the end of the chord it is +c. Water that comes from a chord must therefore be turned by 2 c: by an acceleration
// of the wall, in the rows of the dummies. The images mirror the water at V + c n, its velocity before the turn, so
// they contain none of the turn. A turn by the images would be spread over all rows of water in reach, too little of it
// in the first row. Water that comes tangentially, from a second projection, must be turned by c; its images contain
// all of the turn. With a larger term in the rows, water that circles in a polygon gains energy.
#pragma once

#include <span>

#include "walls/wall_model.h"

namespace tailwater {

/// Curvature S [1/m] of the drawn wall at each row: the mean over 2 dx, so that flat faces count by the angles between
/// them. A turn of more than 40 degrees within dx/4 is a corner; beside corners and in front of other bodies S is 0.
/// Detects walls up to `reach` [m] from their rows. Empty where no wall can be curved.
template <int Dim>
std::vector<Mat<Dim>> find_curvature(const Walls<Dim>& walls, double spacing, double reach);

/// Rotation of walls in a step. The rotations have one entry per wall, or none if no wall moves.
template <int Dim>
struct WallTurns {
  double dt = 0.0;                   ///< s
  std::vector<Mat<Dim>> from_drawn;  ///< from the walls as drawn to those at the start of the step
  std::vector<Mat<Dim>> in_step;     ///< Q
  bool comes_from_chord = true;      ///< whether the water comes from a chord rather than tangentially
};

/// Sets, along these walls, the mirror images of owned dummies in `velocity` (dummies.h) and the `acceleration` [m/s^2]
/// of the water in the rows of the dummies; one entry per owned particle. `V` are the velocities of moving rows.
template <int Dim>
void follow_turning_walls(const WallScene<Dim>& scene, const WallTurns<Dim>& turns, std::span<const Vec<Dim>> V,
                          std::span<Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration);

}  // namespace tailwater
