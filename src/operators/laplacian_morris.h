// Two-point Laplacian of Brookshaw (1985) and Morris et al. (1997), (F11):
//
//   lap v_i = sum_j 2 w_j F_ij (v_j - v_i),    F_ij = -(dW_ij/dr) / r_ij
//
// All weights have one sign, so a matrix of them is an M-matrix; pairs are antisymmetric, so the sum conserves. Exact
// only for linear fields on a symmetric set; on a disordered set it does not converge with dx at fixed h/dx.
#pragma once

#include <cmath>

#include "base/lanes.h"

namespace tailwater {

/// Distances below this fraction of dx count as this: the weight stays bounded for pairing particles.
inline constexpr double min_morris_distance = 0.1;

/// Coefficient of (v_j - v_i) [1/m^2], never negative.
inline double morris_laplacian_weight(double volume_j, double F, double distance_squared, double spacing) {
  const double least = min_morris_distance * spacing;
  const double weight = 2.0 * volume_j * F;
  return distance_squared < least * least ? weight * std::sqrt(distance_squared) / least : weight;
}

/// Factor by which the least distance reduces the weights 2 w_j F of several pairs: 1 for nearly all.
inline Lanes share_of_morris_weight(Lanes distance_squared, double spacing) {
  const double least = min_morris_distance * spacing;
  if (!any_of(distance_squared < in_all_lanes(least * least))) return in_all_lanes(1.0);
  return min_of(in_all_lanes(1.0), sqrt_of(distance_squared) / in_all_lanes(least));
}

}  // namespace tailwater
