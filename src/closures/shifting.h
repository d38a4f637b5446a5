// Particle shifting: small displacements that keep the set evenly spread.
//
//   dr_i = -min(s u_max dt, dx) dx grad C_i, grad C_i = sum w (1 + 0.2 (W/W(dx))^4) grad W, the crowding of
//   concentration.h
//
// The direction and the numbers are Lind et al.'s (2012). The coefficient has the form of Skillen et al. (2013), but
// takes the largest speed of the flow, not the particle's own: at a stagnation point the strain lines particles up
// while their own speed is 0, and a Taylor-Green vortex dies of it (docs/theory/closures.md). The minimum keeps this
// explicit diffusion stable at the long steps of the implicit integrator.
//
// Only a share is kept: 0 wherever the surface is within the support, judged by `interior` (free_surface.h) of the
// particle and its neighbours: there the gradient is that of the surface and would drive water out of the inside.
//
// Shifts have a smooth bound, dr/sqrt(1 + (dr/cap)^2). Ordinary ones are a hundredth of dx and hardly notice it. A
// particle where two bodies of water meet has all its neighbours on one side and would be thrown a quarter of dx.
#pragma once

#include <cmath>
#include <span>

#include "closures/surroundings.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

struct ShiftingLaw {
  double strength = 0.0;  ///< s
  double cap = 0.0;       ///< m; no shift is longer, where particles have the case's spacing
  double spacing = 0.0;   ///< m; of the case
};

/// Keeps a share of a shift and bounds it. Returns whether what is kept was longer than the bound.
template <int Dim>
bool bound_shift(Vec<Dim>& shift, double kept, double cap) {
  shift *= kept;
  const double ratio = shift.norm() / cap;
  shift /= std::sqrt(1.0 + ratio * ratio);
  return ratio > 1.0;
}

/// Shift [m] of every owned particle (zero for walls); `largest_speed` [m/s] is that of the fluid. Returns how many
/// would have been longer than the bound.
template <int Dim>
std::size_t compute_shift(const ShiftingLaw& law, double dt, double largest_speed, const Pairs<Dim>& pairs,
                          const Particles<Dim>& particles, const Surroundings<Dim>& surroundings,
                          std::span<Vec<Dim>> shift);

}  // namespace tailwater
