// The background cells of a multigrid, numbered along a Z curve.
#pragma once

#include <span>

#include "base/vec.h"
#include "base/z_curve.h"
#include "linear/cells.h"

namespace tailwater {

/// [dx]; edge of the cells of a multigrid (cell_multigrid.h).
inline constexpr double cell_edge = 2.0;

/// The cell of the given edge that contains each of the positions; `none` where is_in_a_cell(i) is false. All ranks use
/// the same cells.
template <int Dim, class Predicate>
Cells find_cells(std::span<const Vec<Dim>> position, double edge, Predicate&& is_in_a_cell) {
  Cells cells{.dimension = Dim, .number = std::vector<std::uint64_t>(position.size(), Cells::none)};
  for (std::size_t i = 0; i < position.size(); ++i) {
    if (is_in_a_cell(i)) cells.number[i] = z_number<Dim>(position[i], edge);
  }
  return cells;
}

}  // namespace tailwater
