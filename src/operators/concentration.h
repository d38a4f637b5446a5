// Sums of the kernel and of its gradient over a particle's neighbours:
//
//   C_i = w_i W(0) + sum_j w_j W_ij,    grad C_i = sum_j w_j dW e_ij,    M_i = sum_j w_j r (-dW) e_ij e_ij
//
// C is the share of space around the particle that is filled: 1 (up to quadrature, see lattice.h) inside and smaller at
// a surface; -grad C points out of the fluid. M, the first moment, is what the kernel's gradient makes of a linear
// field: I on a full lattice, and with the eigenvalue 1/2 across a flat surface.
#pragma once

#include <array>
#include <span>

#include "neighbours/pairs.h"

namespace tailwater {

template <int Dim>
struct KernelSums {
  double concentration;   ///< C_i
  Vec<Dim> gradient;      ///< 1/m; grad C_i
  Mat<Dim> first_moment;  ///< M_i
};

template <int Dim>
KernelSums<Dim> kernel_sums(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume, double W_0) {
  double concentration = volume[i] * W_0;
  // Column by column: vectors stay in registers through the loop, whole matrices do not.
  Vec<Dim> gradient = Vec<Dim>::Zero();
  std::array<Vec<Dim>, Dim> columns;
  columns.fill(Vec<Dim>::Zero());
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const double volume_j = volume[pairs.j[k]];
    const Vec<Dim> d = pairs.d[k];
    const Vec<Dim> weight = (volume_j * pairs.F[k]) * d;
    concentration += volume_j * pairs.W[k];
    gradient -= weight;
    for (int b = 0; b < Dim; ++b) columns[b] += weight[b] * d;
  }
  KernelSums<Dim> sums{concentration, gradient, {}};
  for (int b = 0; b < Dim; ++b) sums.first_moment.col(b) = columns[b];
  return sums;
}

}  // namespace tailwater
