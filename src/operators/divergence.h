// Velocity divergence in standard SPH form:
//
//   div u_i = sum_j w_j (u_j - u_i) . grad_i W_ij
//
// Zero for a uniform velocity. Exact for linear fields only on a symmetric full neighbourhood; where neighbours are
// missing, the air counts as moving with the particle, which is right at a free surface. The consistent form is the
// trace of (F9), gradient_consistent.h.
#pragma once

#include <span>

#include "neighbours/pairs.h"

namespace tailwater {

template <int Dim>
double standard_divergence(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                           std::span<const Vec<Dim>> velocity) {
  double sum = 0.0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    sum += volume[j] * pairs.dW[k] * (velocity[j] - velocity[i]).dot(pairs.e[k]);
  }
  return sum;
}

}  // namespace tailwater
