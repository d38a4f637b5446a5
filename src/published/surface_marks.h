// Marks of particles on the free surface, as published: rows of marked particles are p = 0.
//
//   cone     no neighbour within 2.3 dx in a cone of opening 105 degrees around the outward normal -grad C, and
//            C/C_0 < 0.95; or fewer than 5 neighbours; or lambda_min(A) < 0.1. Prototypes of Farzin et al.'s scheme
//            needed this rule instead of (F35), which misses surface particles; the cone around the normal replaces
//            their angular gap, which is 2D only.
//   density  (B21): C/C_0 < beta, where C/C_0 is rho/rho_0; or fewer than half the neighbours of a full lattice.
//            Without the second condition a clump in the air that is as dense as water would have p = 0 nowhere, and
//            its equation no solution
#pragma once

#include <cstdint>
#include <span>

#include "particles/particles.h"
#include "published/renormalisation.h"

namespace tailwater {

/// `concentration` is C/C_0.
template <int Dim>
struct ConeInput {
  const Pairs<Dim>& pairs;
  std::span<const double> concentration;
  std::span<const Vec<Dim>> concentration_gradient;
  std::span<const Renormalisation<Dim>> tensors;
  double spacing;
};

/// Marks owned fluid particles by the cone.
template <int Dim>
void mark_by_cone(const ConeInput<Dim>& input, const Particles<Dim>& particles, std::span<std::uint8_t> is_surface);

/// Marks owned particles by the density ratio `concentration`, walls too.
template <int Dim>
void mark_by_density(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const double> concentration,
                     std::span<std::uint8_t> is_surface);

/// The depth of particles inside the fluid: 0 on marked ones and within 2 dx of them, else 1; 0 for walls. `is_surface`
/// must be up to date on ghosts.
template <int Dim>
void find_interior_by_marks(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing,
                            std::span<const std::uint8_t> is_surface, std::span<double> interior);

}  // namespace tailwater
