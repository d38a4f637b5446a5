// Forces between fluid particles.
#pragma once

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

}  // namespace tailwater
