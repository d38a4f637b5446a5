// Keeps fluid particles in front of walls. Most of this is done by the pressure, through the walls' velocities in its
// source. Two corrections do the rest. Both are continuous and act only nearer than dx/2 to a wall, where a particle's
// own volume begins to overlap the wall:
//
//   overlap  o_i = s^2 (3 - s)/4, s = clamp(1 - 2 d_i/dx, 0, 1), where d_i is the distance to the nearest wall: the
//            fraction of a ball of diameter dx that lies behind the wall's plane. The pressure's source treats it like
//            a density error. A film on a floor has too few neighbours for C/C_0 to reveal the overlap; without this
//            term it sinks until it lies on the wall.
//   cushion  a move from d to d' < d ends at d/(1 + (d - d')/d). This is in front of the wall for any d' (up to 3 dx
//            behind it), and differs from d' only at second order in (d - d')/d. The velocity into the wall is reduced
//            by the same factor, so energy only decreases.
//
// Both are relative to the wall. If the wall moved during the step, d is the distance before the move, from the wall's
// position at that time, and the velocity is relative to that of the wall.
//
// Moves that would have ended behind a wall are counted; a sound run has hardly any.
#pragma once

#include <span>

#include "motion/wall_motion.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// dx; radius of searches for a wall near a particle: the farthest distance behind a wall at which a move can end in a
/// step.
inline constexpr double search_distance = 3.0;

/// Below, `spacing` is that of the case [m]; distances scale with the spacing of each particle.

/// Fills `overlap` of every owned particle; 0 for walls and for particles without a wall particle among their
/// neighbours.
template <int Dim>
void find_wall_overlap(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                       const Particles<Dim>& particles, std::span<double> overlap);

/// Displacements of the walls during a move of the particles.
template <int Dim>
struct WallDisplacements {
  std::vector<AffineMap<Dim>> of_wall;  ///< map of each wall from its position before the move to that after it
  double dt = 0.0;                      ///< s; duration of the move; any value if no wall moved
};

/// Cushions the move of owned fluid particles from `before` to their present positions, for those with a wall particle
/// among their neighbours. `boundary` holds the walls after the move; `displacements` is empty if they rest. `velocity`
/// is the velocity of the move; it is empty for a shift, which has none. Returns the number of particles that would
/// have ended behind a wall.
template <int Dim>
std::size_t keep_off_walls(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                           const WallDisplacements<Dim>& displacements, std::span<const Vec<Dim>> before,
                           Particles<Dim>& particles, std::span<Vec<Dim>> velocity);

}  // namespace tailwater
