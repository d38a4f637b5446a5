// Where walls of different bodies run into each other.
#pragma once

#include <optional>

#include "geometry/boundary.h"

namespace tailwater {

/// Two walls in each other's way.
template <int Dim>
struct Collision {
  Vec<Dim> where;
  bool is_crossing;  ///< else they come nearer than dx to each other
};

/// Looks at faces `a`, of a wall that moves, and `b`. `a_before` and `b_before` are the same faces when they were
/// looked at last: only what comes nearer counts as too near.
template <int Dim>
std::optional<Collision<Dim>> collision(const WallFace<Dim>& a, const WallFace<Dim>& b, const WallFace<Dim>& a_before,
                                        const WallFace<Dim>& b_before, double dx);

}  // namespace tailwater
