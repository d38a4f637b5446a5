// Particles sorted into the cells of a regular grid, so that everything within a cell's edge of a place is found in the
// 3^Dim cells around it.
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

  /// Sorts `positions` into cells of edge `cell_size` [m], or larger where a few far particles would otherwise make the
  /// grid much larger than the set.
  CellGrid(std::span<const Vec<Dim>> positions, double cell_size);

  double cell_size() const { return cell_size_; }

  /// Calls body(j) for every particle in the cells around `place`: all within cell_size(), and some beyond.
  template <class Body>
  void for_each_near(const Vec<Dim>& place, Body&& body) const {
    const auto centre = cell_of(place);
    std::array<std::int64_t, Dim> low;
    std::array<std::int64_t, Dim> high;
    for (int d = 0; d < Dim; ++d) {
      low[d] = std::max<std::int64_t>(centre[d] - 1, 0);
      high[d] = std::min<std::int64_t>(centre[d] + 1, count_[d] - 1);
      if (low[d] > high[d]) return;
    }
    const std::int64_t low_z = Dim == 3 ? low[Dim - 1] : 0;
    const std::int64_t high_z = Dim == 3 ? high[Dim - 1] : 0;
    for (std::int64_t z = low_z; z <= high_z; ++z) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        // The cells of one row lie side by side, so their particles are one range.
        const std::int64_t row = (z * count_[1] + y) * count_[0];
        for (std::int32_t k = cell_begin_[row + low[0]]; k < cell_begin_[row + high[0] + 1]; ++k) {
          body(order_[k]);
        }
      }
    }
  }

 private:
  std::array<std::int64_t, Dim> cell_of(const Vec<Dim>& place) const;
  std::int64_t flat_index(const Vec<Dim>& place) const;

  Vec<Dim> origin_ = Vec<Dim>::Zero();
  double cell_size_ = 1.0;
  std::array<std::int64_t, Dim> count_{};
  std::vector<std::int32_t> cell_begin_;
  std::vector<std::int32_t> order_;
};

}  // namespace tailwater
