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

/// Gradient of a scalar at particle i. The terms are w_i w_j (p_i + p_j) a_ij, which is opposite for the two particles
/// to the last bit, in single precision too, for any volumes. sum_of_ends(batch, p_i, p_j) is p_i + p_j, or another
/// number that is the same for both particles.
template <int Dim, class SumOfEnds>
Vec<Dim> conservative_gradient(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                               const PairVectorField<Dim>& pair_vectors, std::span<const double> field,
                               SumOfEnds&& sum_of_ends) {
  VecSum<Dim> sum;
  const Lanes own_volume = in_all_lanes(volume[i]);
  const Lanes own = in_all_lanes(field[i]);
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PairVectorLanes<Dim> pair = pair_vectors(batch);
    sum += own_volume * pair.place.volume() * sum_of_ends(batch, own, batch.of(field)) * pair.a;
  });
  return sum.total() / volume[i];
}
template <int Dim>
Vec<Dim> conservative_gradient(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                               const PairVectorField<Dim>& pair_vectors, std::span<const double> field) {
  return conservative_gradient<Dim>(
      pairs, i, volume, pair_vectors, field,
      [](const auto& /*batch*/, const Lanes& own, const Lanes& other) { return own + other; });
}

}  // namespace tailwater
