// Sums of the kernel and of its gradient over a particle's neighbours:
//
//   C_i = w_i W(0) + sum_j w_j W_ij,    grad C_i = sum_j w_j dW e_ij,    M_i = sum_j w_j r (-dW) e_ij e_ij
//   crowding_i = sum_j w_j [1 + 0.2 max(0, (W_ij^4 - W(0.8 dx)^4)/W(dx)^4)] dW e_ij
//
// C is the filled fraction of the space around the particle: 1 inside (up to quadrature, see lattice.h) and smaller at
// a surface; -grad C points out of the fluid. M, the first moment, is the result of the kernel's gradient for the
// linear field x: I on a full lattice, and with the eigenvalue 1/2 across a flat surface. The crowding is grad C with
// a weight against pairing: it points to where particles are too close together. The weight of Lind et al. (2012) is
// 1 + 0.2 (W_ij/W(dx))^4. It reads the strain of a lattice too, and takes waves their energy (docs/theory/closures.md).
#pragma once

#include <cmath>

#include "neighbours/pair_lanes.h"
#include "operators/lattice.h"

namespace tailwater {

template <int Dim>
struct KernelSums {
  double concentration;   ///< C_i
  Vec<Dim> gradient;      ///< 1/m; grad C_i
  Mat<Dim> first_moment;  ///< M_i
  Vec<Dim> crowding;      ///< 1/m
};

template <int Dim>
KernelSums<Dim> kernel_sums(const Pairs<Dim>& pairs, std::size_t i, const KernelValues& values) {
  const auto inverse_W = static_cast<float>(1.0 / values.W_spacing);
  const auto close = static_cast<float>(values.close);
  Lanes concentration{};
  VecLanes<Dim> gradient{};
  VecLanes<Dim> crowding{};
  SymmetricLanes<Dim> moment{};
  const double relative = pairs.relative_spacing_of(i);
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PlaceLanes<Dim> place = batch.place();
    const Lanes W = batch.kernel_at(place.d);
    const Lanes ratio = batch.kernel_over_spacing(W) * inverse_W;
    const Lanes squared_ratio = ratio * ratio;
    const Lanes pairing = 1.0F + 0.2F * max_of(squared_ratio * squared_ratio - close, Lanes{});
    const VecLanes<Dim> weights = place.volume() * batch.F(place.d) * place.d;
    concentration += place.volume() * W;
    gradient -= weights;
    crowding -= pairing * weights;
    moment.add(weights, place.d);
  });
  const double volume_i = std::abs(pairs.place[i].signed_volume);
  return {volume_i * (values.W_0 / power<Dim>(relative)) + sum_of(concentration), sum_of(gradient), sum_of(moment),
          sum_of(crowding)};
}

}  // namespace tailwater
