// A set of cells of a lattice: one bit for every cell of a box.
#pragma once

#include <vector>

#include "base/assert.h"
#include "geometry/point_grid.h"

namespace tailwater {

template <int Dim>
class CellSet {
 public:
  CellSet() = default;

  /// An empty set of the cells from `low` to `high`.
  CellSet(const Cell<Dim>& low, const Cell<Dim>& high) : low_(low) {
    std::int64_t cells = 1;
    for (int axis = 0; axis < Dim; ++axis) {
      count_[axis] = high[axis] - low[axis] + 1;
      cells *= count_[axis];
    }
    is_held_.assign(static_cast<std::size_t>(cells), false);
  }

  /// Returns whether the cell, which must be in the box, is new.
  bool add(const Cell<Dim>& cell) {
    const std::int64_t index = index_of(cell);
    TAILWATER_ASSERT(index >= 0, "the box holds all cells that are added");
    const bool is_new = !is_held_[index];
    is_held_[index] = true;
    return is_new;
  }

  bool holds(const Cell<Dim>& cell) const {
    const std::int64_t index = index_of(cell);
    return index >= 0 && is_held_[index];
  }

 private:
  /// -1 outside the box.
  std::int64_t index_of(const Cell<Dim>& cell) const {
    std::int64_t index = 0;
    for (int axis = Dim - 1; axis >= 0; --axis) {
      const std::int64_t from_low = cell[axis] - low_[axis];
      if (from_low < 0 || from_low >= count_[axis]) return -1;
      index = index * count_[axis] + from_low;
    }
    return index;
  }

  Cell<Dim> low_{};
  Cell<Dim> count_{};
  std::vector<bool> is_held_;
};

}  // namespace tailwater
