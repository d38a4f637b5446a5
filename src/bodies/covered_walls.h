// Walls at rest that floating bodies touch. In front of their particles behind such a place is no water, and none would
// have room. The water beside it sees the body go on there, mirrored in the wall: what it does to these particles along
// the wall acts on the body. At a plane of symmetry that is exact, so a box that spans a flume floats as it does in 2D.
// What presses the body off the wall is in the gap (narrow_gaps.h).
#pragma once

#include <vector>

#include "bodies/floating_bodies.h"

namespace tailwater {

/// [dx]; wall particles behind a gap that is this wide are not covered any more.
inline constexpr double widest_cover = 0.5;

/// An owned particle of a wall at rest, behind a place that a body covers.
template <int Dim>
struct CoveredParticle {
  std::size_t i;
  int body;
  Vec<Dim> normal;  ///< of the wall
  double share;     ///< of what acts on it; 1 where the body is well over its place and touches the wall
};

/// With the walls where they are, at `time` [s].
template <int Dim>
std::vector<CoveredParticle<Dim>> find_covered(const Flow<Dim>& flow, const FloatingBodies<Dim>& bodies, double time);

}  // namespace tailwater
