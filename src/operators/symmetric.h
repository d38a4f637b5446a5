// Symmetric Dim x Dim tensors as packed vectors: xx, xy, yy in 2D; xx, xy, xz, yy, yz, zz in 3D.
#pragma once

#include <cmath>

#include "base/vec.h"

namespace tailwater {

template <int Dim>
using Packed = Vec<symmetric_size<Dim>>;

/// a_c b_d for c <= d, symmetric when a = b.
template <int Dim>
Packed<Dim> packed_dyad(const Vec<Dim>& a) {
  Packed<Dim> packed;
  int n = 0;
  for (int c = 0; c < Dim; ++c) {
    for (int d = c; d < Dim; ++d) packed[n++] = a[c] * a[d];
  }
  return packed;
}

/// Number of times that each packed entry occurs in the full tensor: 1 on the diagonal, 2 off it. A : B = sum m A B.
template <int Dim>
Packed<Dim> packed_multiplicity() {
  Packed<Dim> packed;
  int n = 0;
  for (int c = 0; c < Dim; ++c) {
    for (int d = c; d < Dim; ++d) packed[n++] = c == d ? 1.0 : 2.0;
  }
  return packed;
}

template <int Dim>
Packed<Dim> packed_identity() {
  Packed<Dim> packed;
  int n = 0;
  for (int c = 0; c < Dim; ++c) {
    for (int d = c; d < Dim; ++d) packed[n++] = c == d ? 1.0 : 0.0;
  }
  return packed;
}

template <int Dim>
Mat<Dim> unpacked(const Packed<Dim>& packed) {
  Mat<Dim> full;
  int n = 0;
  for (int c = 0; c < Dim; ++c) {
    for (int d = c; d < Dim; ++d) {
      full(c, d) = packed[n];
      full(d, c) = packed[n++];
    }
  }
  return full;
}

/// A symmetric matrix, of which the triangle on and below the diagonal is read.
template <int Dim>
Packed<Dim> packed(const Mat<Dim>& full) {
  Packed<Dim> packed;
  int n = 0;
  for (int c = 0; c < Dim; ++c) {
    for (int d = c; d < Dim; ++d) packed[n++] = full(d, c);
  }
  return packed;
}

double min_eigenvalue_of(const Mat<3>& matrix);

/// Least eigenvalue of a symmetric matrix.
template <int Dim>
double min_eigenvalue(const Mat<Dim>& matrix) {
  if constexpr (Dim == 2) {
    const double half_difference = 0.5 * (matrix(0, 0) - matrix(1, 1));
    const double off_diagonal = matrix(1, 0);
    return 0.5 * (matrix(0, 0) + matrix(1, 1)) -
           std::sqrt(half_difference * half_difference + off_diagonal * off_diagonal);
  } else {
    return min_eigenvalue_of(matrix);
  }
}

}  // namespace tailwater
