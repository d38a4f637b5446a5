// Detects collisions of walls of different bodies.
#pragma once

#include <optional>

#include "geometry/boundary.h"

namespace tailwater {

/// A collision of two walls.
template <int Dim>
struct Collision {
  Vec<Dim> where;
  bool is_crossing;  ///< false: their distance becomes less than dx
};

/// Checks face `a`, of a moving wall, against face `b`. `a_before` and `b_before` are the same faces at the previous
/// check: only faces that approach count as too near.
template <int Dim>
std::optional<Collision<Dim>> collision(const WallFace<Dim>& a, const WallFace<Dim>& b, const WallFace<Dim>& a_before,
                                        const WallFace<Dim>& b_before, double dx);

}  // namespace tailwater
