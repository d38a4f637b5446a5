// Consistent second derivative, Farzin et al. (2014), (F12), written as the matrix row (F23):
//
//   lap v_i = sum_j c_ij (v_j - v_i),   c_ij = 2 w_j (W_ij/r_ij) [ (e . B2 . e)/r_ij - drift . e ],
//   drift = B1 . (C : B2)
//
// The available copy of the paper prints "+" before the second term; the sign here follows from (F12) with (F9)
// inserted for grad v, and a test checks it. Exact for quadratic fields where B1 and B2 exist. Not an M-matrix on a
// disordered set: 30 to 60 % of the rows have coefficients of the wrong sign.
#pragma once

#include "published/renormalisation.h"

namespace tailwater {

/// Coefficient c_ij of (v_j - v_i) [1/m^2].
template <int Dim>
double consistent_laplacian_weight(const Renormalisation<Dim>& tensors, double volume_j, const Vec<Dim>& e, double r,
                                   double W) {
  const double B2_ee = (unpacked<Dim>(tensors.B2) * e).dot(e);
  return 2.0 * volume_j * W / r * (B2_ee / r - tensors.drift.dot(e));
}

/// The scaled two-point weight that replaces (F23) in a row whose B2 is unsound: 2 w W/r^2 * 2/max(0.5, tr A), never
/// negative. Distances below dx/2 count as dx/2.
template <int Dim>
double fallback_laplacian_weight(const Renormalisation<Dim>& tensors, double volume_j, double r, double W,
                                 double spacing) {
  const double r_used = std::max(r, 0.5 * spacing);
  return 2.0 * volume_j * W / (r_used * r_used) * Dim / std::max(0.5, tensors.trace_A);
}

/// Laplacian of a scalar or vector field at particle i.
template <int Dim, class Value>
Value consistent_laplacian(const Pairs<Dim>& pairs, std::size_t i, const Renormalisation<Dim>& tensors,
                           std::span<const double> volume, std::span<const std::uint8_t> takes_part,
                           std::span<const Value> field, Value zero) {
  Value sum = zero;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (!takes_part[j] || pairs.value(i, k) == 0.0) continue;
    sum += consistent_laplacian_weight<Dim>(tensors, volume[j], pairs.e(i, k), pairs.r(i, k), pairs.value(i, k)) *
           (field[j] - field[i]);
  }
  return sum;
}

}  // namespace tailwater
