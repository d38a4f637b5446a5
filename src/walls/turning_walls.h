// Walls that turn while water runs along them, seen at mid-step: curved ones, and those that rotate
// (docs/theory/moving_walls.md#walls-at-mid-step). In a step water moves along a chord of such a wall, tangential to it
// at mid-step. At the start of the step its velocity into the wall is therefore not that of the wall, but
//
//   n . (u - V) = -c,   c = t . (dt/2 S t + (Q - I) n),   t = (I - M) (u - V)
//
// V, n, M  velocity, normal and blocked directions of the wall
// S        its curvature: the normal turns by S d over a distance d along the wall
// Q        its rotation in the step
//
// At the end of the chord it is +c. So water that comes from a chord has to be turned by 2 c: by an acceleration of the
// wall, in the rows of the dummies. The images mirror the water at V + c n, the velocity that it comes with, so they
// ask for none of the turn: what they ask for is spread over the rows of water in reach, and the first one gets too
// little. Water that comes tangentially, from a second projection, has to be turned by c; its images show all of it.
// With more in the rows water that circles in a polygon gains energy.
#pragma once

#include <span>

#include "walls/wall_model.h"

namespace tailwater {

/// The curvature S [1/m] at each row, of the wall as it is drawn: the mean over 2 dx, so that flat faces count by the
/// angles between them. A turn of more than 40 degrees within dx/4 is a corner; beside corners and in front of other
/// bodies S is 0. Finds walls up to `reach` [m] from their rows. Empty where no wall can be curved.
template <int Dim>
std::vector<Mat<Dim>> find_curvature(const Walls<Dim>& walls, double spacing, double reach);

/// How walls turn in a step. The rotations have one entry per wall, or none if no wall moves.
template <int Dim>
struct WallTurns {
  double dt = 0.0;                   ///< s
  std::vector<Mat<Dim>> from_drawn;  ///< to where the walls are at the start of the step
  std::vector<Mat<Dim>> in_step;     ///< Q
  bool comes_from_chord = true;      ///< as above
};

/// Along these walls, sets the mirror images of owned dummies in `velocity` (dummies.h) and the `acceleration` [m/s^2]
/// of the water that belongs in their rows; one entry per owned particle. `V` are the velocities of moving rows.
template <int Dim>
void follow_turning_walls(const WallScene<Dim>& scene, const WallTurns<Dim>& turns, std::span<const Vec<Dim>> V,
                          std::span<Vec<Dim>> velocity, std::span<Vec<Dim>> acceleration);

}  // namespace tailwater
