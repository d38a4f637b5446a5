// C* and its gradient as a table over the place, which is filled where particles come: a quadrature for each particle
// in each step would be most of the cost of a step. Nodes are shared by all places with the same spacings around them,
// so that a plane face needs a line of nodes and an edge a plane of them. They belong to the field as drawn, which
// zones that move carry with them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "operators/graded_sums.h"

namespace tailwater {

template <int Dim>
class ContinuumTable {
 public:
  /// Sums at a place, and grad C* [1/m].
  struct Entry {
    ContinuumSums<Dim> sums;
    Vec<Dim> slope = Vec<Dim>::Zero();
  };

  /// At a place, between nodes; computes those of them that are not known.
  Entry at(const GradedSums<Dim>& sums, const Vec<Dim>& x);

 private:
  static constexpr int corners = 1 << Dim;
  using Node = std::array<std::int32_t, Dim>;
  struct Hash {
    std::size_t operator()(const Node& node) const;
  };
  using Corners = std::array<std::int32_t, corners>;

  const Corners& corners_of(const GradedSums<Dim>& sums, const Node& first);

  std::vector<ContinuumSums<Dim>> sums_;               ///< of nodes
  std::unordered_map<Node, std::int32_t, Hash> node_;  ///< their numbers in sums_
  std::unordered_map<Node, Corners, Hash> cell_;       ///< nodes of a cell, by its first
};

}  // namespace tailwater
