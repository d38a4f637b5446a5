// Keeps fluid particles in front of walls. The pressure does most of this, through the walls' velocities in its source.
// Two corrections do the rest. Both are continuous and act only nearer than dx/2 to a wall, where a particle's own
// volume begins to reach into it:
//
//   overlap  o_i = s^2 (3 - s)/4, s = clamp(1 - 2 d_i/dx, 0, 1), where d_i is the distance to the nearest wall: the
//            share of a ball of diameter dx that lies behind the wall's plane. The pressure's source treats it like any
//            density error. A film on a floor has too few neighbours for C/C_0 to show the overlap; without this term
//            it sinks until it lies on the wall.
//   cushion  a move from d to d' < d ends at d/(1 + (d - d')/d). This is in front of the wall wherever d' is (up to 3
//            dx behind it), and differs from d' only at second order in (d - d')/d. The velocity into the wall is
//            reduced by the same factor, so energy only falls.
//
// Both are relative to the wall. If the wall moved during the step, d is the distance before the move, from where the
// wall was then, and the velocity is relative to the wall's.
//
// Moves that would have ended behind a wall are counted; a sound run has hardly any.
#pragma once

#include <span>

#include "motion/wall_motion.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// dx; what looks for a wall near a particle looks no farther: behind the wall, as far as a move in one step can end.
inline constexpr double search_distance = 3.0;

/// In what follows `spacing` is that of the case [m]; distances scale with the spacing of each particle.

/// Fills `overlap` of every owned particle; 0 for walls and for particles without a wall particle among their
/// neighbours.
template <int Dim>
void find_wall_overlap(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                       const Particles<Dim>& particles, std::span<double> overlap);

/// How the walls moved during a move of the particles.
template <int Dim>
struct WallDisplacements {
  std::vector<AffineMap<Dim>> of_wall;  ///< map of each wall from where it was to where it is
  double dt = 0.0;                      ///< s; duration of the move; any value if no wall moved
};

/// Cushions the move of owned fluid particles from `before` to their present positions, for those with a wall particle
/// among their neighbours. `boundary` holds the walls after the move; `displacements` is empty if they rest. `velocity`
/// is the velocity of the move; it is empty for a shift, which has none. Returns how many particles would have ended
/// behind a wall.
template <int Dim>
std::size_t keep_off_walls(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                           const WallDisplacements<Dim>& displacements, std::span<const Vec<Dim>> before,
                           Particles<Dim>& particles, std::span<Vec<Dim>> velocity);

}  // namespace tailwater
