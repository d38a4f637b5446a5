#include "neighbours/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/for_each.h"

namespace tailwater {
namespace {

/// Directions sorted by the spread of the positions along them, largest first. The spread is the standard deviation,
/// which a single distant particle does not dominate.
template <int Dim>
std::array<int, Dim> axes_by_spread(std::span<const Vec<Dim>> positions) {
  const Vec<Dim> zero = Vec<Dim>::Zero();
  const Vec<Dim> mean = sum_over(positions.size(), zero, [&](std::size_t i) -> Vec<Dim> {
    return positions[i] / static_cast<double>(positions.size());
  });
  const Vec<Dim> spread =
      sum_over(positions.size(), zero, [&](std::size_t i) -> Vec<Dim> { return (positions[i] - mean).cwiseAbs2(); });
  std::array<int, Dim> axes;
  std::iota(axes.begin(), axes.end(), 0);
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return spread[a] > spread[b]; });
  return axes;
}

/// Added to the square of a reach, as a share of it: more than what is rounded.
constexpr double rounding = 1e-6;

}  // namespace

template <int Dim>
CellGrid<Dim>::CellGrid(std::span<const Vec<Dim>> positions, double reach) : edge_(reach / cells_per_reach) {
  if (positions.empty()) return;

  Vec<Dim> low = positions[0];
  Vec<Dim> high = positions[0];
  for (const Vec<Dim>& position : positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  origin_ = low;
  axis_ = axes_by_spread<Dim>(positions);

  // A few distant particles must not make the grid huge. Coarser cells are slower, never wrong.
  const double most_cells = 64.0 * static_cast<double>(positions.size()) + 1e5;
  const auto cells_along = [&](int d) {
    return std::floor((high[axis_[d]] - low[axis_[d]]) / edge_) + 1.0 + 2.0 * rim;
  };
  for (;; edge_ *= 2.0) {
    double cells = 1.0;
    for (int d = 0; d < Dim; ++d) cells *= cells_along(d);
    if (cells <= most_cells) break;
  }
  std::int64_t cells = 1;
  for (int d = 0; d < Dim; ++d) {
    count_[d] = static_cast<std::int64_t>(cells_along(d));
    cells *= count_[d];
  }
  find_rows();

  // A counting sort: find each particle's cell, count the particles of each cell, and place them.
  std::vector<std::int64_t> cell(positions.size());
  for_each(positions.size(), [&](std::size_t i) {
    cell[i] = 0;
    for (int d = 0; d < Dim; ++d) {
      cell[i] = cell[i] * count_[d] + static_cast<std::int64_t>(in_cells(positions[i], d));
    }
  });
  cell_begin_.assign(cells + 1, 0);
  for (const std::int64_t c : cell) ++cell_begin_[c + 1];
  for (std::int64_t c = 0; c < cells; ++c) {
    cell_begin_[c + 1] += cell_begin_[c];
  }
  std::vector<std::int32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  order_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    order_[next[cell[i]]++] = static_cast<std::int32_t>(i);
  }
}

template <int Dim>
void CellGrid<Dim>::find_rows() {
  constexpr int n = cells_per_reach;
  for (int part = 0; part < (1 << Dim); ++part) {
    const auto begins = [&](int d) { return 0.5 * (part >> d & 1); };  // the part of a cell along axis d
    const auto ends = [&](int d) { return begins(d) + 0.5; };
    const auto gap = [&](int d, int cells) { return std::max({cells - ends(d), begins(d) - (cells + 1), 0.0}); };
    constexpr int along = Dim - 1;
    constexpr int between = Dim - 2;
    for (int slab = Dim == 3 ? -n : 0; slab <= (Dim == 3 ? n : 0); ++slab) {
      for (int row = -n; row <= n; ++row) {
        double squared = n * n * (1.0 + rounding) - gap(between, row) * gap(between, row);
        if (Dim == 3) squared -= gap(0, slab) * gap(0, slab);
        if (squared < 0.0) continue;
        const double reach = std::sqrt(squared);
        const auto first = std::max<std::int64_t>(std::floor(begins(along) - reach), -n);
        const auto last = std::min<std::int64_t>(std::floor(ends(along) + reach), n);
        const std::int64_t cell = ((Dim == 3 ? slab * count_[between] : 0) + row) * count_[along];
        rows_[part].push_back({cell + first, cell + last + 1});
      }
    }
  }
}

template <int Dim>
int CellGrid<Dim>::find_ranges_near(const Vec<Dim>& place, Ranges& ranges) const {
  std::int64_t cell = 0;
  int part = 0;
  for (int d = 0; d < Dim; ++d) {
    const double coordinate = in_cells(place, d);
    // Compared before it is cast: the index of a place far outside may not fit an integer.
    if (!(coordinate >= cells_per_reach && coordinate < static_cast<double>(count_[d] - cells_per_reach))) return 0;
    const auto halves = static_cast<std::int64_t>(2.0 * coordinate);
    cell = cell * count_[d] + halves / 2;
    part |= static_cast<int>(halves % 2) << d;
  }
  const std::int32_t* const begin = cell_begin_.data() + cell;
  Range* next = ranges.data();
  for (const Row& row : rows_[part]) {  // without a branch, which would be taken as good as at random
    const Range range{begin[row.begin], begin[row.end]};
    *next = range;
    next += range.begin < range.end ? 1 : 0;
  }
  return static_cast<int>(next - ranges.data());
}

template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace tailwater
