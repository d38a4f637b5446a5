// Conservative pressure gradient with constant volumes:
//
//   grad p_i = sum_j w_j (p_i + p_j) a_ij,   a_ij of pair_vectors.h
//
// Antisymmetric pair by pair: linear momentum is conserved to round-off, and missing neighbours count as p = 0,
// which is the condition at a free surface. Not zero for a constant p on a disordered set.
#pragma once

#include <span>

#include "neighbours/pairs.h"

namespace tailwater {

/// Gradient of a scalar at particle i.
template <int Dim>
Vec<Dim> conservative_gradient(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                               std::span<const Vec<Dim>> pair_vectors, std::span<const double> field) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    sum += (volume[j] * (field[i] + field[j])) * pair_vectors[k];
  }
  return sum;
}

}  // namespace tailwater
