#include "operators/continuum_table.h"

#include <cmath>

namespace tailwater {
namespace {

/// Nodes per dx. Between them C* is off by 6e-5 in 2D and 3e-4 in 3D.
template <int Dim>
constexpr double nodes_per_spacing = Dim == 2 ? 8.0 : 4.0;

/// The cell of nodes around a place.
template <int Dim>
struct NodeCell {
  std::array<std::int32_t, Dim> first;
  Vec<Dim> share;  ///< of the way to the next node

  NodeCell(const Vec<Dim>& x, double step) {
    for (int d = 0; d < Dim; ++d) {
      const double place = x[d] / step;
      first[d] = static_cast<std::int32_t>(std::floor(place));
      share[d] = place - first[d];
    }
  }
  std::array<std::int32_t, Dim> corner(int n) const {
    std::array<std::int32_t, Dim> node = first;
    for (int d = 0; d < Dim; ++d) node[d] += n >> d & 1;
    return node;
  }
};

template <int Dim>
Vec<Dim> place_of(const std::array<std::int32_t, Dim>& node, double step) {
  return Vec<Dim>::NullaryExpr([&](int d) { return step * node[d]; });
}

constexpr int corners(int dim) { return 1 << dim; }

}  // namespace

template <int Dim>
void ContinuumTable<Dim>::prepare(const GradedSums<Dim>& sums, std::span<const Vec<Dim>> places) {
  const double step = sums.spacing() / nodes_per_spacing<Dim>;
  for (Vec<Dim> x : places) {
    if (!sums.field().varies_around(x, kernel_radius(sums.kernel()))) continue;
    const NodeCell<Dim> cell(x, step);
    for (int n = 0; n < corners(Dim); ++n) {
      const Node node = cell.corner(n);
      if (!nodes_.contains(node)) nodes_.emplace(node, sums.continuum(place_of<Dim>(node, step)));
    }
  }
}

template <int Dim>
typename ContinuumTable<Dim>::Entry ContinuumTable<Dim>::at(const GradedSums<Dim>& sums, const Vec<Dim>& x) const {
  Vec<Dim> place = x;
  if (!sums.field().varies_around(place, kernel_radius(sums.kernel()))) return {};
  const double step = sums.spacing() / nodes_per_spacing<Dim>;
  const NodeCell<Dim> cell(place, step);
  Entry entry{{0.0, Vec<Dim>::Zero(), Packed<Dim>::Zero()}, Vec<Dim>::Zero()};
  for (int n = 0; n < corners(Dim); ++n) {
    const ContinuumSums<Dim>& node = nodes_.at(cell.corner(n));
    Vec<Dim> shares;
    Vec<Dim> signs;
    for (int d = 0; d < Dim; ++d) {
      const bool is_next = (n >> d & 1) != 0;
      shares[d] = is_next ? cell.share[d] : 1.0 - cell.share[d];
      signs[d] = is_next ? 1.0 : -1.0;
    }
    const double weight = shares.prod();
    entry.sums.concentration += weight * node.concentration;
    entry.sums.gradient += weight * node.gradient;
    entry.sums.first_moment += weight * node.first_moment;
    for (int d = 0; d < Dim; ++d) {
      Vec<Dim> others = shares;
      others[d] = signs[d] / step;
      entry.slope[d] += others.prod() * node.concentration;
    }
  }
  return entry;
}

template class ContinuumTable<2>;
template class ContinuumTable<3>;

}  // namespace tailwater
