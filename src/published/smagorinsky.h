// Sub-particle stress of Farzin et al. (2014), (F4)-(F6), after Lo & Shao (2002):
//
//   tau/rho = 2 nu_t S - 2/3 k I,  nu_t = (c_s dx)^2 |S|,  |S| = sqrt(2 S:S),  k = (nu_t/(0.08 dx))^2
//
// S comes from the consistent gradient (F9) over fluid neighbours; the stress is 0 where that is unsound. The
// divergence has the conservative form sum_j w_j (tau_i + tau_j) . grad W over fluid neighbours, which conserves
// momentum to round-off.
#pragma once

#include <span>

#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// Stress over density [m^2/s^2] of every owned particle.
template <int Dim>
void sub_particle_stress(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double c_s, double spacing,
                         std::span<const Vec<Dim>> velocity, std::span<Mat<Dim>> stress);

/// Adds (1/rho) div tau; `stress` must be up to date on ghosts.
template <int Dim>
void add_stress_divergence(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const Mat<Dim>> stress,
                           std::span<Vec<Dim>> acceleration);

}  // namespace tailwater
