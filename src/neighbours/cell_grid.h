// Particles sorted into the cells of a regular grid: all particles within reach of a place are in the cells around it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace tailwater {

template <int Dim>
class CellGrid {
 public:
  /// With three, a search tests half as many particles as with cells as long as the reach.
  static constexpr int cells_per_reach = 3;

  CellGrid() = default;

  /// Sorts `positions` into cells with a third of `reach` [m] as edge. The cells are larger if a few distant particles
  /// would otherwise make the grid much larger than the set.
  CellGrid(std::span<const Vec<Dim>> positions, double reach);

  /// m; the reach of the constructor, or larger.
  double reach() const { return cells_per_reach * edge_; }

  /// Particle indices cell by cell: slab by slab along the direction of largest extent, and row by row in a slab. A
  /// batch beyond the end can be read; it holds 0.
  std::span<const std::int32_t> order() const { return std::span(order_).first(size_); }

  /// Calls body(begin, end) for successive ranges of order(), which together hold all particles within `reach` [m] of
  /// the box from `low` to `high`, and some farther away.
  template <class Body>
  [[gnu::always_inline, gnu::flatten]] void for_each_range_near(const Vec<Dim>& low, const Vec<Dim>& high, double reach,
                                                                Body&& body) const {
    const double reach_in_cells = (1.0 + margin_of_reach) * reach / edge_;
    Vec<Dim> first;
    Vec<Dim> last;
    for (int d = 0; d < Dim; ++d) {
      first[d] = in_cells(low, d);
      last[d] = in_cells(high, d);
    }
    const auto visit_row = [&](std::int64_t row, double squared) {
      if (squared < 0.0) return;
      const auto [begin, end] = cells_within(Dim - 1, std::sqrt(squared), first, last);
      const std::int32_t* const cell_begin = cell_begin_.data() + row * count_[Dim - 1];
      body(cell_begin[begin], cell_begin[end]);
    };
    const auto visit_slab = [&](std::int64_t slab, double squared) {
      const auto [begin, end] = cells_within(Dim - 2, reach_in_cells, first, last);
      for (std::int64_t row = begin; row < end; ++row) {
        visit_row(slab * count_[Dim - 2] + row, squared - squared_gap(Dim - 2, row, first, last));
      }
    };
    const double squared_reach = reach_in_cells * reach_in_cells;
    if constexpr (Dim == 2) {
      visit_slab(0, squared_reach);
    } else {
      const auto [begin, end] = cells_within(0, reach_in_cells, first, last);
      for (std::int64_t slab = begin; slab < end; ++slab) {
        visit_slab(slab, squared_reach - squared_gap(0, slab, first, last));
      }
    }
  }

  /// Calls body(j) for all particles within reach() of `place`, and for some farther away.
  template <class Body>
  void for_each_near(const Vec<Dim>& place, Body&& body) const {
    for_each_range_near(place, place, reach(), [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t n = begin; n < end; ++n) body(order_[n]);
    });
  }

 private:
  /// Fraction of a reach, for rounding errors.
  static constexpr double margin_of_reach = 1e-6;

  /// Distance from the first cell to `place` along axis_[d], in edges of a cell.
  double in_cells(const Vec<Dim>& place, int d) const { return (place[axis_[d]] - origin_[axis_[d]]) / edge_; }

  /// Range of the cells along axis_[d] within `reach` of the interval from `first` to `last`, all in cells.
  std::pair<std::int64_t, std::int64_t> cells_within(int d, double reach, const Vec<Dim>& first,
                                                     const Vec<Dim>& last) const {
    // Clamped before the cast: the index of a place far outside may not fit an integer.
    const auto cell = [&](double place) {
      return static_cast<std::int64_t>(std::min(std::max(0.0, place), static_cast<double>(count_[d])));
    };
    return {cell(first[d] - reach), cell(last[d] + reach + 1.0)};
  }

  /// Squared distance [cells^2] along axis_[d] from a cell to the interval from `first` to `last`.
  static double squared_gap(int d, std::int64_t cell, const Vec<Dim>& first, const Vec<Dim>& last) {
    const auto begin = static_cast<double>(cell);
    const double before = first[d] - (begin + 1.0);
    const double behind = begin - last[d];
    const double gap = (before > 0.0 ? before : 0.0) + (behind > 0.0 ? behind : 0.0);  // at least one of them is 0
    return gap * gap;
  }

  Vec<Dim> origin_ = Vec<Dim>::Zero();
  double edge_ = 1.0;
  std::array<int, Dim> axis_{};            ///< directions: the first is normal to the slabs, the last is along the rows
  std::array<std::int64_t, Dim> count_{};  ///< cells along each axis_
  std::vector<std::int32_t> cell_begin_;
  std::size_t size_ = 0;  ///< number of particles
  std::vector<std::int32_t> order_;
};

}  // namespace tailwater
