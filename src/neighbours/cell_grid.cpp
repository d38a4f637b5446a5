#include "neighbours/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/batch.h"
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
  const Vec<Dim> spread = sum_over(positions.size(), zero, [&](std::size_t i) {
    return (positions[i] - mean).each([](double x) { return x * x; });
  });
  std::array<int, Dim> axes;
  std::iota(axes.begin(), axes.end(), 0);
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return spread[a] > spread[b]; });
  return axes;
}

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
  const double max_cells = 64.0 * static_cast<double>(positions.size()) + 1e5;
  const auto cells_along = [&](int d) { return std::floor((high[axis_[d]] - low[axis_[d]]) / edge_) + 1.0; };
  for (;; edge_ *= 2.0) {
    double cells = 1.0;
    for (int d = 0; d < Dim; ++d) cells *= cells_along(d);
    if (cells <= max_cells) break;
  }
  std::int64_t cells = 1;
  for (int d = 0; d < Dim; ++d) {
    count_[d] = static_cast<std::int64_t>(cells_along(d));
    cells *= count_[d];
  }

  // A counting sort: find each particle's cell, count the particles of each cell, and place them.
  std::vector<std::int64_t> cell(positions.size());
  for_each(positions.size(), [&](std::size_t i) {
    cell[i] = 0;
    for (int d = 0; d < Dim; ++d) cell[i] = cell[i] * count_[d] + static_cast<std::int64_t>(in_cells(positions[i], d));
  });
  cell_begin_.assign(cells + 1, 0);
  for (const std::int64_t c : cell) ++cell_begin_[c + 1];
  for (std::int64_t c = 0; c < cells; ++c) cell_begin_[c + 1] += cell_begin_[c];
  std::vector<std::int32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  size_ = positions.size();
  order_.resize(size_ + batch_size);
  for (std::size_t i = 0; i < positions.size(); ++i) order_[next[cell[i]]++] = static_cast<std::int32_t>(i);
}

template class CellGrid<2>;
template class CellGrid<3>;

}  // namespace tailwater
