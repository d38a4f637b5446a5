// Interfaces between liquids of different density. In liquids at rest dp = rho g . dx along any path. If an interface
// is halfway between two particles, their pressures differ by
//
//   p_j - p_i = rho_ij g . (r_j - r_i),   rho_ij = (rho_i + rho_j)/2,
//
// and the pressure halfway is p_ij = (rho_j p_i + rho_i p_j)/(rho_i + rho_j), as Hu & Adams (2007) have it. With
// 1/rho_ij as the weight of a pair in the pressure equation and p_ij in the gradient, forces are opposite pair by pair,
// and (p_ij - p_i)/rho_i = (p_j - p_i)/(2 rho_ij): equation and gradient see the same flux.
//
// Particles of walls count as the liquid of the nearest fluid. Derivation: docs/theory/liquids.md.
#pragma once

#include <cstdint>
#include <vector>

#include "neighbours/pair_lanes.h"
#include "particles/liquids.h"
#include "particles/particles.h"

namespace tailwater {

template <int Dim>
struct Halo;

/// Empty if the case has one liquid.
struct Interfaces {
  std::vector<float> density;         ///< of all particles, over that of the case (Setup::liquid); of dry walls 1
  std::vector<std::uint8_t> is_near;  ///< of owned particles: whether their support reaches another liquid

  bool are_any() const { return !density.empty(); }
  /// rho_ij over the density of the case.
  template <class Batch>
  Lanes density_of(const Batch& batch) const {
    return 0.5F * (density[batch.i] + batch.of(std::span<const float>(density)));
  }
  /// 2 p_ij; `own` and `other` are the pressures of the two particles. Written as twice the mean and a correction, it
  /// is the same for both particles to the last bit. In a sum of two products the compiler may fuse either product with
  /// the sum, so that the result depends on the order of the particles.
  template <class Batch>
  Lanes twice_pressure_of(const Batch& batch, const Lanes& own, const Lanes& other) const {
    const Lanes of_other = batch.of(std::span<const float>(density));
    const float of_own = density[batch.i];
    return own + other + (of_own - of_other) * (other - own) / (of_own + of_other);
  }
};

/// `density` is that of the case [kg/m^3]. Collective.
template <int Dim>
Interfaces find_interfaces(const Pairs<Dim>& pairs, const Particles<Dim>& particles, const ParticleLiquids& liquids,
                           const Halo<Dim>& halo, double density);

}  // namespace tailwater
