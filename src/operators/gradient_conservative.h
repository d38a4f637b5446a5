// Conservative pressure gradient with constant volumes:
//
//   grad p_i = sum_j w_j (p_i + p_j) a_ij,   a_ij of pair_vectors.h
//
// Antisymmetric pair by pair: linear momentum is conserved to round-off, and missing neighbours count as p = 0,
// which is the condition at a free surface. Not zero for a constant p on a disordered set.
#pragma once

#include <span>

#include "operators/pair_vectors.h"

namespace tailwater {

/// Gradient of a scalar at particle i.
template <int Dim>
Vec<Dim> conservative_gradient(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                               const PairVectorField<Dim>& pair_vectors, std::span<const double> field) {
  VecLanes<Dim> sum{};
  for_each_lanes(pairs.begin(i), pairs.end(i), [&](auto range) {
    const LaneIndices j = range.neighbours(pairs.j.data());
    const Lanes weight = range.only(j(volume.data())) * (field[i] + j(field.data()));
    const VecLanes<Dim> a = pair_vectors(pairs, range, j, i).a;
    for (int d = 0; d < Dim; ++d) sum.at[d] += weight * a.at[d];
  });
  return sum_of(sum);
}

}  // namespace tailwater
