// Pressure gradient with each particle's own density, (B7) (Monaghan 1992), in terms of the density ratio c = rho/rho_0
// and of w = m/rho_0:
//
//   rho_0 (1/rho grad p)_i = sum_j w_j (p_i/c_i^2 + p_j/c_j^2) grad_i W_ij
//
// Antisymmetric pair by pair and along e_ij: conserves linear and angular momentum to round-off, whatever p and c.
// Missing neighbours count as p = 0. With c = 1 it is conservative_gradient. Not zero for a constant p
// on a disordered set.
#pragma once

#include <span>

#include "neighbours/pairs.h"

namespace tailwater {

/// The contribution of pair k of particle i to the gradient below, along pairs.e(i, k).
template <int Dim>
double density_weighted_slope(const Pairs<Dim>& pairs, std::size_t i, std::size_t k, std::span<const double> volume,
                              std::span<const double> density, std::span<const double> field) {
  const auto j = pairs.j[k];
  const double own = field[i] / (density[i] * density[i]);
  return volume[j] * pairs.slope(i, k) * (own + field[j] / (density[j] * density[j]));
}

/// rho_0/rho times the gradient of a scalar at particle i; `density` is c.
template <int Dim>
Vec<Dim> density_weighted_gradient(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume,
                                   std::span<const double> density, std::span<const double> field) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    sum += density_weighted_slope<Dim>(pairs, i, k, volume, density, field) * pairs.e(i, k);
  }
  return sum;
}

}  // namespace tailwater
