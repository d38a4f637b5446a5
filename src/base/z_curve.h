// Numbers background cells along a Z curve (Morton 1966), which interleaves the bits of their coordinates. Cells with
// consecutive numbers are near each other, and the 2^Dim cells that make up one twice as large follow each other.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/vec.h"

namespace tailwater {

/// Spreads the bits of `value`: Dim - 1 zeros between each and the next.
template <int Dim>
constexpr std::uint64_t spread_bits(std::uint64_t value) {
  if constexpr (Dim == 2) {
    value = (value | value << 16) & 0x0000ffff0000ffff;
    value = (value | value << 8) & 0x00ff00ff00ff00ff;
    value = (value | value << 4) & 0x0f0f0f0f0f0f0f0f;
    value = (value | value << 2) & 0x3333333333333333;
    return (value | value << 1) & 0x5555555555555555;
  } else {
    value = (value | value << 32) & 0x001f00000000ffff;
    value = (value | value << 16) & 0x001f0000ff0000ff;
    value = (value | value << 8) & 0x100f00f00f00f00f;
    value = (value | value << 4) & 0x10c30c30c30c30c3;
    return (value | value << 2) & 0x1249249249249249;
  }
}

/// The number of the cell of the given edge [m] that contains `position`. Its last Dim bits are its place in the cell
/// twice as large, whose number is the other bits. Numbers repeat after 2^21 cells along an axis, so the distance of
/// the positions from the origin does not matter.
template <int Dim>
std::uint64_t z_number(const Vec<Dim>& position, double edge) {
  constexpr std::uint64_t period = 0x200000;  // 21 bits for each coordinate
  constexpr double half = 0x100000;           // the curve is cut there, and not at the origin
  std::uint64_t number = 0;
  for (int d = 0; d < Dim; ++d) {
    const auto coordinate = static_cast<std::int64_t>(std::floor(position[d] / edge + half));
    number |= spread_bits<Dim>(static_cast<std::uint64_t>(coordinate) % period) << d;
  }
  return number;
}

}  // namespace tailwater
