// Sums over a particle's fluid neighbours: forces, means.
#pragma once

#include <span>

#include "neighbours/pairs.h"
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
/// `own_weight`. 0 if all weights are 0. `field` must be up to date on ghosts.
template <int Dim>
double mean_over_fluid(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::size_t i,
                       std::span<const double> field, double own_weight) {
  double sum = own_weight * field[i];
  double weight = own_weight;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (!particles.is_fluid(j)) continue;
    sum += pairs.W[k] * field[j];
    weight += pairs.W[k];
  }
  return weight > 0.0 ? sum / weight : 0.0;
}

}  // namespace tailwater
