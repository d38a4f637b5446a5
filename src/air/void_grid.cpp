#include "air/void_grid.h"

#include <algorithm>
#include <bit>

#include "base/box.h"

namespace tailwater {
namespace {

/// Cells around the box: space for the rows of particles behind walls, and for air beside them.
constexpr int rim = 8;

}  // namespace

template <int Dim>
VoidGrid<Dim>::VoidGrid(const Box<Dim>& box, double spacing, const PeriodicDomain<Dim>& domain) {
  const double wanted = 0.5 * spacing;
  rows_ = 1;
  for (int d = 0; d < Dim; ++d) {
    repeats_[d] = domain[d].has_value();
    const double low = repeats_[d] ? domain[d]->first : box.min()[d];
    const double high = repeats_[d] ? domain[d]->second : box.max()[d];
    const double cells = (high - low) / wanted;
    count_[d] = repeats_[d] ? std::max(1, static_cast<int>(std::lround(cells)))
                            : static_cast<int>(std::ceil(cells - 1e-6)) + 2 * rim;
    edge_[d] = repeats_[d] ? (high - low) / count_[d] : wanted;
    origin_[d] = repeats_[d] ? low : low - rim * wanted;
    if (d < Dim - 1) rows_ *= count_[d];
  }
}

template <int Dim>
Vec<Dim> VoidGrid<Dim>::centre(const Cell& c) const {
  Vec<Dim> x;
  for (int d = 0; d < Dim; ++d) x[d] = origin_[d] + (c[d] + 0.5) * edge_[d];
  return x;
}

template <int Dim>
typename VoidGrid<Dim>::Cell VoidGrid<Dim>::cell(int row, int place) const {
  if constexpr (Dim == 2) {
    return {row, place};
  } else {
    return {row / count_[1], row % count_[1], place};
  }
}

template <int Dim>
bool VoidGrid<Dim>::step(Cell& c, int axis, int direction) const {
  c[axis] += direction;
  return wrap(axis, c[axis]);
}

template <int Dim>
int VoidGrid<Dim>::row_beside(int row, int axis, int direction) const {
  Cell c = cell(row, 0);
  return step(c, axis, direction) ? row_of(c) : -1;
}

int CellMarks::next(int row, int from, int end, std::uint64_t unlike) const {
  for (int k = from / 64; 64 * k < end; ++k) {
    const std::uint64_t wanted = (word(row, k) ^ unlike) & mask(k, from, end);
    if (wanted != 0) return 64 * k + std::countr_zero(wanted);
  }
  return end;
}

CellMarks& CellMarks::operator|=(const CellMarks& other) {
  for (std::size_t k = 0; k < words_.size(); ++k) words_[k] |= other.words_[k];
  return *this;
}

template class VoidGrid<2>;
template class VoidGrid<3>;

}  // namespace tailwater
