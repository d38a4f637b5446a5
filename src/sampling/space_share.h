// Parts of space: cubes, distributed so that neighbouring cubes belong to different parts. The work per part is
// therefore balanced, wherever the geometry is.
#pragma once

#include <cstdint>

#include "geometry/point_grid.h"

namespace tailwater {

/// All of space, or the cubes of one of several parts.
struct SpaceShare {
  double edge = 1.0;  ///< m; of a cube
  int share = 0;
  int shares = 1;

  template <int Dim>
  bool holds(const Vec<Dim>& x) const {
    return shares == 1 || share_of<Dim>(x) == share;
  }

  /// Whether a cube of the part may be within `distance` (m), less than an edge, of `x`.
  template <int Dim>
  bool is_near(const Vec<Dim>& x, double distance) const {
    if (shares == 1) return true;
    for (int corner = 0; corner < 1 << Dim; ++corner) {
      Vec<Dim> at = x;
      for (int axis = 0; axis < Dim; ++axis) at[axis] += (corner >> axis & 1) != 0 ? distance : -distance;
      if (share_of<Dim>(at) == share) return true;
    }
    return false;
  }

 private:
  template <int Dim>
  int share_of(const Vec<Dim>& x) const {
    constexpr std::uint64_t scatter = 0x9e3779b97f4a7c15;  // 2^64 over the golden ratio: Knuth's multiplicative hash
    const std::uint64_t mixed = cell_key<Dim>(cell_of<Dim>(x, edge)) * scatter >> 32;
    return static_cast<int>(mixed % static_cast<std::uint64_t>(shares));
  }
};

}  // namespace tailwater
