// Numbers background cells along a Z curve (Morton 1966), which interleaves the bits of their coordinates.
#pragma once

#include <algorithm>
#include <span>

#include "base/vec.h"
#include "linear/cells.h"

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

/// The cell of the given edge that holds each of the positions; `none` where is_in_a_cell(i) is false. All ranks share
/// the cells.
template <int Dim, class Predicate>
Cells find_cells(std::span<const Vec<Dim>> position, double edge, Predicate&& is_in_a_cell) {
  constexpr double half = 0x100000;  // 21 bits for each coordinate; cells farther out share the outermost
  Cells cells{.dimension = Dim, .number = std::vector<std::uint64_t>(position.size(), Cells::none)};
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (!is_in_a_cell(i)) continue;
    std::uint64_t number = 0;
    for (int d = 0; d < Dim; ++d) {
      const double coordinate = std::clamp(position[i][d] / edge + half, 0.0, 2.0 * half - 1.0);
      number |= spread_bits<Dim>(static_cast<std::uint64_t>(coordinate)) << d;
    }
    cells.number[i] = number;
  }
  return cells;
}

}  // namespace tailwater
