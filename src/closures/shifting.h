// Particle shifting: small displacements that keep the set evenly spread.
//
//   lind    dr_i = -min(s u_max dt, dx) dx grad C_i, grad C_i = sum w (1 + 0.2 (W/W(dx))^4) grad W, the crowding of
//           concentration.h. The direction and the numbers are Lind et al.'s (2012). The coefficient has the form of
//           Skillen et al. (2013), but takes the largest speed of the flow, not the particle's own: at a stagnation
//           point the strain lines particles up while their own speed is 0, and a Taylor-Green vortex dies of it
//           (docs/theory/closures.md). The minimum keeps this explicit diffusion stable at the long steps of the
//           implicit integrator.
//   farzin  dr_i = eps |u_i| dt R_i, R_i = sum (rbar_i/r_ij)^3 e_ij (F28-F30)
//
// Of both only a share is kept: 0 where `interior` (free_surface.h) is 0, 1 where that is 1. With lind the share is 0
// wherever the surface is within the support, judged by `interior` of the neighbours: there the gradient is that of the
// surface and would drive water out of the inside.
//
// Both have a smooth bound, dr/sqrt(1 + (dr/cap)^2). Ordinary shifts are a hundredth of dx and hardly notice it. A
// particle where two bodies of water meet has all its neighbours on one side and would be thrown a quarter of dx.
//
// (F31) and (F32), the correction of u and p by their gradients, are part of the published scheme (flow/shift.cpp).
#pragma once

#include <cstdint>
#include <span>

#include "case/scheme_choices.h"
#include "closures/surroundings.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

struct ShiftingLaw {
  ShiftingKind kind = ShiftingKind::lind;
  double strength = 0.0;  ///< s or eps
  double cap = 0.0;       ///< m; no shift is longer
  double spacing = 0.0;   ///< m
};

/// Shift [m] of every owned particle (zero for walls); `largest_speed` [m/s] is that of the fluid. Returns how many
/// would have been longer than the bound.
template <int Dim>
std::size_t compute_shift(const ShiftingLaw& law, double dt, double largest_speed, const Pairs<Dim>& pairs,
                          const Particles<Dim>& particles, const Surroundings<Dim>& here, std::span<Vec<Dim>> shift);

}  // namespace tailwater
