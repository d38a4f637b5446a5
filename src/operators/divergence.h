// Velocity divergence in standard SPH form:
//
//   div u_i = sum_j w_j (u_j - u_i) . a_ij,   a_ij of pair_vectors.h
//
// Zero for a uniform velocity. Where neighbours are missing, the air counts as moving with the particle, which is right
// at a free surface. The consistent form is the trace of (F9), gradient_consistent.h.
#pragma once

#include <span>

#include "neighbours/pairs.h"

namespace tailwater {

template <int Dim>
double standard_divergence(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                           std::span<const Vec<Dim>> pair_vectors, std::span<const Vec<Dim>> velocity) {
  double sum = 0.0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    sum += volume[j] * (velocity[j] - velocity[i]).dot(pair_vectors[k]);
  }
  return sum;
}

}  // namespace tailwater
