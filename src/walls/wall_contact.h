// What keeps fluid particles in front of walls. The pressure does most of it, through mirror velocities in its source.
// Two things are left to do, both continuous and at work nearer than dx/2 to a wall only, where a particle's own volume
// begins to reach into it:
//
//   overlap  o_i = s^2 (3 - s)/4, s = clamp(1 - 2 d_i/dx, 0, 1), d_i the distance from the nearest wall: the share of a
//            ball of diameter dx behind the wall's plane. A density error like any other in the pressure's source. A
//            film on a floor has too few neighbours for C/C_0 to show it, and without it sinks until it lies on the
//            wall.
//   cushion  a move from d to d' < d ends at d/(1 + (d - d')/d): in front of the wall wherever d' is (up to 3 dx behind
//            it), and off d' by the second order of (d - d')/d only. The velocity into the wall is reduced by the same
//            factor, so energy only falls.
//
// All of it is relative to the wall: where a wall moved in the same time, d is that from where it was and the velocity
// that relative to its own.
//
// A move that would have ended behind a wall is counted: a sound run hardly needs the cushion for that.
#pragma once

#include <span>

#include "geometry/wall_motion.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// dx; what looks for a wall near a particle looks no farther: behind the wall, as far as a move in one step can end.
inline constexpr double search_distance = 3.0;

/// Fills `overlap` of every owned particle; 0 for walls and for particles without a wall particle among their
/// neighbours.
template <int Dim>
void find_wall_overlap(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                       const Particles<Dim>& particles, std::span<double> overlap);

/// How the walls moved in the time of a move.
template <int Dim>
struct WallWays {
  std::vector<AffineMap<Dim>> way;  ///< by wall: from where it was to where it is
  double dt = 0.0;                  ///< s; the time of the move; any number if nothing moved
};

/// Cushions the way of owned fluid particles from `before` to their positions, for those that have a wall particle
/// among their neighbours. `walls` are where they are after the move; `ways` is empty for a move during which they
/// rest, `velocity` that of the move, empty for a move that no velocity made. Returns how many would have ended behind
/// a wall.
template <int Dim>
std::size_t keep_off_walls(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                           const WallWays<Dim>& ways, std::span<const Vec<Dim>> before, Particles<Dim>& particles,
                           std::span<Vec<Dim>> velocity);

}  // namespace tailwater
