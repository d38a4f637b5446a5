// C* and its gradient as a table over the place, which is filled where particles come: a quadrature for each particle
// in each step would be most of the cost of a step. Nodes are shared by all places with the same spacings around them,
// so that a plane face needs a line of nodes and an edge a plane of them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>

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

  /// Computes the nodes around these places that are not known.
  void prepare(const GradedSums<Dim>& sums, std::span<const Vec<Dim>> places);
  /// At a place around which the nodes are known, between them.
  Entry at(const GradedSums<Dim>& sums, const Vec<Dim>& x) const;

 private:
  using Node = std::array<std::int32_t, Dim>;

  std::map<Node, ContinuumSums<Dim>> nodes_;
};

}  // namespace tailwater
