// Sums of the kernel and of its gradient over a particle's neighbours:
//
//   C_i = w_i W(0) + sum_j w_j W_ij,    grad C_i = sum_j w_j dW e_ij,    M_i = sum_j w_j r (-dW) e_ij e_ij
//
// C is the share of space around the particle that is filled: 1 (up to quadrature, see lattice.h) inside and smaller at
// a surface; -grad C points out of the fluid. M, the first moment, is what the kernel's gradient makes of a linear
// field: I on a full lattice, and with the eigenvalue 1/2 across a flat surface.
#pragma once

#include <cmath>

#include "neighbours/pair_lanes.h"

namespace tailwater {

template <int Dim>
struct KernelSums {
  double concentration;   ///< C_i
  Vec<Dim> gradient;      ///< 1/m; grad C_i
  Mat<Dim> first_moment;  ///< M_i
};

template <int Dim>
KernelSums<Dim> kernel_sums(const Pairs<Dim>& pairs, std::size_t i, double W_0) {
  Lanes concentration{};
  VecLanes<Dim> gradient{};
  SymmetricLanes<Dim> moment{};
  for_each_lanes(
      pairs.begin(i), pairs.end(i), [&](auto range) __attribute__((always_inline)) {
        const LaneIndices j = range.neighbours(pairs.j.data());
        const PlaceLanes<Dim> place = neighbour_places(pairs, range, j, i);
        concentration += place.volume() * kernel_at(pairs, place.d);
        const Lanes volume_F = place.volume() * range.load(pairs.F.data());
        VecLanes<Dim> weights;
        for (int a = 0; a < Dim; ++a) {
          weights.at[a] = volume_F * place.d.at[a];
          gradient.at[a] -= weights.at[a];
        }
        moment.add(weights, place.d);
      });
  const double volume_i = std::abs(pairs.place[i].signed_volume);
  return {volume_i * W_0 + sum_of(concentration), sum_of(gradient), sum_of(moment)};
}

}  // namespace tailwater
