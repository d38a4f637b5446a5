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
};

template <int Dim>
Vec<Dim> place_of(const std::array<std::int32_t, Dim>& node, double step) {
  return Vec<Dim>::NullaryExpr([&](int d) { return step * node[d]; });
}

/// The sums of a field that has turned.
template <int Dim>
typename ContinuumTable<Dim>::Entry turned(const typename ContinuumTable<Dim>::Entry& drawn, const Mat<Dim>& turn) {
  const Mat<Dim> moment = turn * unpacked<Dim>(drawn.sums.first_moment) * turn.transpose();
  return {{drawn.sums.concentration, turn * drawn.sums.gradient, packed<Dim>(moment)}, turn * drawn.slope};
}

/// Node n of a cell.
template <std::size_t Dim>
std::array<std::int32_t, Dim> corner(std::array<std::int32_t, Dim> node, int n) {
  for (std::size_t d = 0; d < Dim; ++d) node[d] += n >> d & 1;
  return node;
}

}  // namespace

template <int Dim>
std::size_t ContinuumTable<Dim>::Hash::operator()(const Node& node) const {
  std::uint64_t hash = 0;
  for (const std::int32_t number : node) hash = (hash + static_cast<std::uint32_t>(number)) * 0x9E3779B97F4A7C15U;
  return hash ^ hash >> 32U;
}

template <int Dim>
const typename ContinuumTable<Dim>::Corners& ContinuumTable<Dim>::corners_of(const GradedSums<Dim>& sums,
                                                                             const Node& first) {
  const auto [cell, is_new] = cell_.try_emplace(first);
  if (!is_new) return cell->second;
  const double step = sums.spacing() / nodes_per_spacing<Dim>;
  for (int n = 0; n < corners; ++n) {
    const Node node = corner(first, n);
    const auto [number, is_unknown] = node_.try_emplace(node, static_cast<std::int32_t>(sums_.size()));
    if (is_unknown) sums_.push_back(sums.continuum(place_of<Dim>(node, step)));
    cell->second[n] = number->second;
  }
  return cell->second;
}

template <int Dim>
typename ContinuumTable<Dim>::Entry ContinuumTable<Dim>::at(const GradedSums<Dim>& sums, const Vec<Dim>& x) {
  Vec<Dim> place = sums.field().drawn(x);
  if (!sums.field().varies_around(place, kernel_radius(sums.kernel()))) return {};
  const double step = sums.spacing() / nodes_per_spacing<Dim>;
  const NodeCell<Dim> cell(place, step);
  const Corners& nodes = corners_of(sums, cell.first);
  Entry entry{{0.0, Vec<Dim>::Zero(), Packed<Dim>::Zero()}, Vec<Dim>::Zero()};
  for (int n = 0; n < corners; ++n) {
    const ContinuumSums<Dim>& node = sums_[nodes[n]];
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
  return sums.field().moves() ? turned<Dim>(entry, sums.field().turn()) : entry;
}

template class ContinuumTable<2>;
template class ContinuumTable<3>;

}  // namespace tailwater
