// The share of space around a particle that is filled:
//
//   C_i = w_i W(0) + sum_j w_j W_ij,    grad C_i = sum_j w_j grad_i W_ij
//
// C is 1 (up to quadrature, see lattice.h) inside and smaller at a surface; -grad C points out of the fluid.
#pragma once

#include <span>
#include <utility>

#include "neighbours/pairs.h"

namespace tailwater {

/// C_i [1] and grad C_i [1/m], in one pass over the row.
template <int Dim>
std::pair<double, Vec<Dim>> concentration_with_gradient(const Pairs<Dim>& pairs, std::size_t i,
                                                        std::span<const double> volume, double W_0) {
  double sum = volume[i] * W_0;
  Vec<Dim> gradient = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const double volume_j = volume[pairs.j[k]];
    sum += volume_j * pairs.W[k];
    gradient += (volume_j * pairs.dW[k]) * pairs.e[k];
  }
  return {sum, gradient};
}

template <int Dim>
Vec<Dim> concentration_gradient(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> volume) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    sum += (volume[pairs.j[k]] * pairs.dW[k]) * pairs.e[k];
  }
  return sum;
}

}  // namespace tailwater
