// Velocity divergence in standard SPH form:
//
//   div u_i = sum_j w_j (u_j - u_i) . a_ij,   a_ij of pair_vectors.h
//
// Zero for a uniform velocity. Where neighbours are missing, the air counts as moving with the particle, which is right
// at a free surface. The consistent form is the trace of (F9), published/gradient_consistent.h.
#pragma once

#include <span>

#include "operators/pair_vectors.h"

namespace tailwater {

template <int Dim>
double standard_divergence(const Pairs<Dim>& pairs, std::size_t i, const PairVectorField<Dim>& pair_vectors,
                           std::span<const Float4> velocity) {
  LaneSum sum;
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PairVectorLanes<Dim> pair = pair_vectors(batch);
    sum += pair.place.volume() * (batch.of(velocity) - velocity[i]).dot(pair.a);
  });
  return sum.total();
}

}  // namespace tailwater
