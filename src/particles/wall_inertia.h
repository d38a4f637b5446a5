// The accelerations with which walls carry the pressure of the water beside them, by wall particle.
#pragma once

#include <cstddef>
#include <span>

#include "base/vec.h"
#include "particles/particles.h"

namespace tailwater {

/// Entries belong to rows of walls (Particles::wall_row), or to particles.
template <int Dim>
struct WallInertia {
  std::span<const Mat<Dim>> blocked;       ///< of each row: the directions in which the wall drives the water
  std::span<const Vec<Dim>> acceleration;  ///< m/s^2; of each row of walls that move, in these directions
  std::span<const Vec<Dim>> turning;       ///< m/s^2; of water that turns with walls, at each particle; or empty

  /// m/s^2; of the water at wall particle j, in the blocked directions.
  Vec<Dim> acceleration_at(const Particles<Dim>& particles, std::size_t j) const {
    const auto row = static_cast<std::size_t>(particles.wall_row[j]);
    Vec<Dim> sum = row < acceleration.size() ? acceleration[row] : Vec<Dim>(Vec<Dim>::Zero());
    if (!turning.empty()) sum += turning[j];
    return sum;
  }
};

}  // namespace tailwater
