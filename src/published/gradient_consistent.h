// Consistent first derivative, Farzin et al. (2014), (F9):
//
//   grad v_i = sum_j w_j B1_i . (W_ij/r_ij) (-e_ij) (v_j - v_i)
//
// Exact for linear fields wherever B1 exists, at boundaries too. Not conservative: the sum of the forces of a pair is
// not zero. Zero for a constant field, so p may be shifted by a constant.
#pragma once

#include "published/renormalisation.h"

namespace tailwater {

/// Weight of (v_j - v_i) in the gradient at i [1/m].
template <int Dim>
Vec<Dim> consistent_gradient_weight(const Mat<Dim>& B1, double volume_j, const Vec<Dim>& e, double r, double W) {
  return -(volume_j * W / r) * (B1 * e);
}

/// Gradient of a scalar at particle i.
template <int Dim>
Vec<Dim> consistent_gradient(const Pairs<Dim>& pairs, std::size_t i, const Mat<Dim>& B1, std::span<const double> volume,
                             std::span<const std::uint8_t> takes_part, std::span<const double> field) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (!takes_part[j]) continue;
    sum -= (volume[j] * pairs.value(i, k) / pairs.r(i, k) * (field[j] - field[i])) * pairs.e(i, k);
  }
  return B1 * sum;
}

/// Gradient of a vector at particle i: result(a, b) = d field_a / d x_b.
template <int Dim>
Mat<Dim> consistent_gradient(const Pairs<Dim>& pairs, std::size_t i, const Mat<Dim>& B1, std::span<const double> volume,
                             std::span<const std::uint8_t> takes_part, std::span<const Vec<Dim>> field) {
  Mat<Dim> sum = Mat<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (!takes_part[j]) continue;
    sum -= (volume[j] * pairs.value(i, k) / pairs.r(i, k)) * (field[j] - field[i]) * pairs.e(i, k).transpose();
  }
  return sum * B1;  // B1 is symmetric
}

}  // namespace tailwater
