// Cells of dx/2 over the space in which there may be air, and marks on them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "neighbours/halo.h"

namespace tailwater {

/// The cells. A row of them runs along the last axis; rows are counted along the other axes. Directions that repeat
/// have a whole number of cells.
template <int Dim>
class VoidGrid {
 public:
  using Cell = std::array<int, Dim>;

  VoidGrid() = default;
  /// Covers the `box` and some cells around it. Cells begin at the lowest corner of the box, so walls that are drawn in
  /// multiples of dx are between cells.
  VoidGrid(const Box<Dim>& box, double spacing, const PeriodicDomain<Dim>& domain);

  int rows() const { return rows_; }
  int length() const { return count_[Dim - 1]; }  ///< number of cells of a row
  int count(int axis) const { return count_[axis]; }
  bool repeats(int axis) const { return repeats_[axis]; }
  double cell_volume() const { return edge_.prod(); }
  const Vec<Dim>& edge() const { return edge_; }
  Vec<Dim> centre(const Cell& c) const;

  int row_of(const Cell& c) const { return Dim == 2 ? c[0] : c[0] * count_[1] + c[Dim - 2]; }
  Cell cell(int row, int place) const;

  /// The cell beside `c`, across a periodic border too. Returns false if there is none.
  bool step(Cell& c, int axis, int direction) const;
  /// The row beside a row along one of the other axes; -1 if there is none.
  int row_beside(int row, int axis, int direction) const;
  /// Wraps a cell's index along an axis into the range if the direction repeats. Returns whether it is in the range.
  bool wrap(int axis, int& index) const {
    const int n = count_[axis];
    if (repeats_[axis]) index = ((index % n) + n) % n;
    return index >= 0 && index < n;
  }

  /// x in cells: the centre of cell c is at c.
  Vec<Dim> in_cells(const Vec<Dim>& x) const { return (x - origin_).cwiseQuotient(edge_) - Vec<Dim>::Constant(0.5); }

  /// Calls visit(row, begin, end) for the pieces of rows whose cells' centres are within `radius` of x.
  template <class Visit>
  void visit_ball(const Vec<Dim>& x, double radius, Visit&& visit) const {
    const Vec<Dim> at = in_cells(x);
    Cell low{};
    Cell high{};
    for (int d = 0; d < Dim - 1; ++d) {
      low[d] = static_cast<int>(std::ceil(at[d] - radius / edge_[d]));
      high[d] = static_cast<int>(std::floor(at[d] + radius / edge_[d]));
    }
    Cell c = low;
    for (int axis = 0; axis < Dim - 1;) {
      visit_chord(at, radius, c, visit);
      for (axis = 0; axis < Dim - 1 && ++c[axis] > high[axis]; ++axis) c[axis] = low[axis];
    }
  }

 private:
  template <class Visit>
  void visit_chord(const Vec<Dim>& at, double radius, Cell c, Visit&& visit) const {
    double square = radius * radius;
    for (int d = 0; d < Dim - 1; ++d) {
      const double offset = (c[d] - at[d]) * edge_[d];
      square -= offset * offset;
      if (!wrap(d, c[d])) return;
    }
    if (square < 0.0) return;
    const double half = std::sqrt(square) / edge_[Dim - 1];
    const int begin = static_cast<int>(std::ceil(at[Dim - 1] - half));
    const int end = static_cast<int>(std::floor(at[Dim - 1] + half)) + 1;
    visit_pieces(row_of(c), begin, end, visit);
  }

  template <class Visit>
  void visit_pieces(int row, int begin, int end, Visit&& visit) const {
    const int n = length();
    if (!repeats_[Dim - 1]) {
      begin = std::max(begin, 0);
      end = std::min(end, n);
      if (begin < end) visit(row, begin, end);
      return;
    }
    const int cells = std::min(end - begin, n);
    wrap(Dim - 1, begin);
    if (cells > 0) visit(row, begin, std::min(begin + cells, n));
    if (begin + cells > n) visit(row, 0, begin + cells - n);
  }

  Vec<Dim> origin_ = Vec<Dim>::Zero();
  Vec<Dim> edge_ = Vec<Dim>::Ones();
  Cell count_{};
  std::array<bool, Dim> repeats_{};
  int rows_ = 0;
};

/// A mark on each cell of a grid.
class CellMarks {
 public:
  CellMarks() = default;
  CellMarks(int rows, int length)
      : words_per_row_(static_cast<std::size_t>(length + 63) / 64), words_(words_per_row_ * rows) {}

  void clear() { std::fill(words_.begin(), words_.end(), 0); }
  bool operator()(int row, int place) const { return (word(row, place / 64) >> (place % 64) & 1U) != 0; }
  /// Marks the cells begin <= place < end of a row.
  void mark(int row, int begin, int end) {
    for (int k = begin / 64; 64 * k < end; ++k) words_[words_per_row_ * row + k] |= mask(k, begin, end);
  }
  /// Whether one of these cells is marked.
  bool any(int row, int begin, int end) const {
    for (int k = begin / 64; 64 * k < end; ++k) {
      if ((word(row, k) & mask(k, begin, end)) != 0) return true;
    }
    return false;
  }
  /// The first marked place from `from` on, before `end`; `end` if there is none.
  int next_marked(int row, int from, int end) const { return next(row, from, end, 0); }
  /// The first unmarked place, in the same range.
  int next_unmarked(int row, int from, int end) const { return next(row, from, end, ~std::uint64_t{0}); }

  CellMarks& operator|=(const CellMarks& other);
  /// The marks, for an exchange.
  std::span<std::uint64_t> words() { return words_; }

 private:
  std::uint64_t word(int row, int k) const { return words_[words_per_row_ * row + k]; }
  static std::uint64_t mask(int k, int begin, int end) {
    std::uint64_t mask = ~std::uint64_t{0};
    if (begin > 64 * k) mask &= ~std::uint64_t{0} << (begin - 64 * k);
    if (end < 64 * (k + 1)) mask &= ~std::uint64_t{0} >> (64 * (k + 1) - end);
    return mask;
  }

  /// The first place whose mark differs from `unlike`.
  int next(int row, int from, int end, std::uint64_t unlike) const;

  std::size_t words_per_row_ = 0;
  std::vector<std::uint64_t> words_;
};

}  // namespace tailwater
