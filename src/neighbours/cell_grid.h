// Particles sorted into the cells of a regular grid: all particles within reach of a place are in the cells around it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace tailwater {

template <int Dim>
class CellGrid {
 public:
  /// With three, a search looks at half as many particles as with cells of the whole reach.
  static constexpr int cells_per_reach = 3;
  /// How many cells hold what is within reach, at most.
  static constexpr int cells_across = 2 * cells_per_reach + 1;

  CellGrid() = default;

  /// Sorts `positions` into cells of a third of `reach` [m]. Cells are larger if a few distant particles would
  /// otherwise make the grid much larger than the set.
  CellGrid(std::span<const Vec<Dim>> positions, double reach);

  /// The reach asked for, or larger.
  double reach() const { return cells_per_reach * edge_; }

  /// Particle indices cell by cell: slab by slab along the direction of largest spread, and row by row in a slab.
  std::span<const std::int32_t> order() const { return order_; }

  /// Entries of order() that lie side by side.
  struct Range {
    std::int32_t begin;
    std::int32_t end;
  };
  /// One for each row of cells.
  using Ranges = std::array<Range, Dim == 3 ? cells_across * cells_across : cells_across>;

  /// Finds ranges, in the order of order(), that hold all particles within reach() of `place`, and some farther away.
  /// Returns how many there are; they come first in `ranges`.
  int find_ranges_near(const Vec<Dim>& place, Ranges& ranges) const;

  /// Calls body(j) for all particles within reach() of `place`, and for some farther away.
  template <class Body>
  void for_each_near(const Vec<Dim>& place, Body&& body) const {
    Ranges ranges;
    const int count = find_ranges_near(place, ranges);
    for (int r = 0; r < count; ++r) {
      for (std::int32_t n = ranges[r].begin; n < ranges[r].end; ++n) body(order_[n]);
    }
  }

 private:
  /// Empty cells beside the others, so that a search looks at the same cells wherever it begins.
  static constexpr int rim = 2 * cells_per_reach;

  /// Cells of one row that hold particles within reach, as distances of their indices from that of the cell in whose
  /// neighbourhood they are.
  struct Row {
    std::int64_t begin;
    std::int64_t end;
  };

  /// Where `place` is along axis_[d], in edges of a cell from the first one.
  double in_cells(const Vec<Dim>& place, int d) const { return (place[axis_[d]] - origin_[axis_[d]]) / edge_ + rim; }
  void find_rows();

  Vec<Dim> origin_ = Vec<Dim>::Zero();
  double edge_ = 1.0;
  std::array<int, Dim> axis_{};            ///< directions: first the one across the slabs, last the one along the rows
  std::array<std::int64_t, Dim> count_{};  ///< cells along each axis_, with the rim
  std::array<std::vector<Row>, 1 << Dim> rows_;  ///< for each part of a cell: halves along each axis
  std::vector<std::int32_t> cell_begin_;
  std::vector<std::int32_t> order_;
};

}  // namespace tailwater
