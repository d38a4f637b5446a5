// Sums over a particle's fluid neighbours: forces, means.
#pragma once

#include <span>

#include "neighbours/pair_lanes.h"
#include "particles/particles.h"

namespace tailwater {

/// Sum of force(j, k) over the fluid neighbours j of particle i; k is the entry of the pair.
template <int Dim, class Force>
Vec<Dim> sum_over_fluid(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::size_t i, Force&& force) {
  Vec<Dim> sum = Vec<Dim>::Zero();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (particles.is_fluid(j)) sum += force(j, k);
  }
  return sum;
}

/// Kernel-weighted mean of `field` over the fluid neighbours of particle i and the particle itself, which has weight
/// `own_weight` at the case's spacing. Where particles have several spacings, weights are by volume. 0 if all weights
/// are 0. `field` must be up to date on ghosts.
template <int Dim>
double mean_over_fluid(const Pairs<Dim>& pairs, std::size_t i, std::span<const double> field, double own_weight) {
  Lanes sums{};
  Lanes weights{};
  for_each_pair(pairs, i, [&](const auto& batch) {
    const Lanes weight = batch.kernel_of_fluid();
    sums += weight * batch.of(field);
    weights += weight;
  });
  const double own = pairs.is_graded() ? own_weight * pairs.weight_in_means_of(i) : own_weight;
  const double weight = own + sum_of(weights);
  return weight > 0.0 ? (own * field[i] + sum_of(sums)) / weight : 0.0;
}

}  // namespace tailwater
