// Particles sorted into the cells of a regular grid: all particles within reach of a place are in the cells around it.
// The cell order is also the best order of the particles in memory (docs/theory/neighbours.md).
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
  CellGrid() = default;

  /// Sorts `positions` into cells of a third of `reach` [m]. Cells are larger if a few distant particles would
  /// otherwise make the grid much larger than the set.
  CellGrid(std::span<const Vec<Dim>> positions, double reach);

  /// The reach asked for, or larger.
  double reach() const { return cells_per_reach * edge_; }

  /// Particle indices cell by cell: slab by slab along the direction of largest spread, and row by row in a slab.
  std::span<const std::int32_t> order() const { return order_; }

  /// Calls body(j) for every particle in the cells around `place`: all within reach(), and some farther away.
  template <class Body>
  void for_each_near(const Vec<Dim>& place, Body&& body) const {
    for_each_range_near(place, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t n = begin; n < end; ++n) body(order_[n]);
    });
  }

  /// The same by ranges of order(): calls body(begin, end).
  template <class Body>
  void for_each_range_near(const Vec<Dim>& place, Body&& body) const {
    const auto centre = cell_of(place);
    std::array<std::int64_t, Dim> low;
    std::array<std::int64_t, Dim> high;
    for (int d = 0; d < Dim; ++d) {
      low[d] = std::max<std::int64_t>(centre[d] - cells_per_reach, 0);
      high[d] = std::min<std::int64_t>(centre[d] + cells_per_reach, count_[d] - 1);
      if (low[d] > high[d]) return;
    }
    const std::int64_t low_middle = Dim == 3 ? low[1] : 0;
    const std::int64_t high_middle = Dim == 3 ? high[1] : 0;
    for (std::int64_t a = low[0]; a <= high[0]; ++a) {
      for (std::int64_t b = low_middle; b <= high_middle; ++b) {
        // The cells of one row lie side by side, so their particles are one range.
        const std::int64_t row = (Dim == 3 ? a * count_[1] + b : a) * count_[Dim - 1];
        const std::int32_t begin = cell_begin_[row + low[Dim - 1]];
        const std::int32_t end = cell_begin_[row + high[Dim - 1] + 1];
        if (begin < end) body(begin, end);
      }
    }
  }

 private:
  /// With three, a search looks at half as many particles as with cells of the whole reach.
  static constexpr int cells_per_reach = 3;

  std::array<std::int64_t, Dim> cell_of(const Vec<Dim>& place) const;
  std::int64_t flat_index(const Vec<Dim>& place) const;

  Vec<Dim> origin_ = Vec<Dim>::Zero();
  double edge_ = 1.0;
  std::array<int, Dim> axis_{};            ///< directions: first the one across the slabs, last the one along the rows
  std::array<std::int64_t, Dim> count_{};  ///< cells along each axis_
  std::vector<std::int32_t> cell_begin_;
  std::vector<std::int32_t> order_;
};

}  // namespace tailwater
