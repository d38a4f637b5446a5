// The table of the particles that represent the walls.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// Particles that represent the walls. They never move relative to their wall.
template <int Dim>
struct WallParticles {
  std::vector<Vec<Dim>> position;
  /// Unit normal of the wall into the fluid; at a corner the normalised mean of the adjacent normals.
  std::vector<Vec<Dim>> normal;
  /// Symmetric projector M onto the directions that the wall blocks: the sum of n n^T over the adjacent normals, with
  /// its eigenvalues clipped at 1. It is n n^T at a flat wall, I at a right-angled corner, and changes continuously in
  /// between. The free-slip mirror image of the velocity u is u - 2 M u.
  std::vector<Mat<Dim>> blocked;
  /// Columns: normals of the walls beyond convex edges in reach, nearest first; 0 where there are none.
  std::vector<Mat<Dim>> beyond_edges;
  std::vector<double> share;                ///< volume over dx^Dim
  std::vector<int> wall;                    ///< index into Boundary::walls
  std::vector<std::uint8_t> is_beyond_end;  ///< 1: beyond a free end of its wall, acts through the wall's screens only
  /// Number of its place among all proposed places: unique, whichever part of space is sampled. The numbers of
  /// particles on the wall itself come first.
  std::vector<std::int64_t> number;
  std::int64_t numbers = 0;          ///< upper limit of all numbers, exclusive
  std::int64_t numbers_on_wall = 0;  ///< upper limit of the numbers of particles on the wall itself, exclusive

  std::size_t size() const { return position.size(); }
  bool is_on_wall(std::int32_t row) const { return number[row] < numbers_on_wall; }

  /// Calls body with references to the entries of the particles.
  template <class Body>
  void apply_to_fields(Body&& body) {
    body(position, normal, blocked, beyond_edges, share, wall, is_beyond_end, number);
  }
  template <class Body>
  void apply_to_fields(Body&& body) const {
    body(position, normal, blocked, beyond_edges, share, wall, is_beyond_end, number);
  }
};

}  // namespace tailwater
