// Particle shifting: small displacements that keep particles evenly spread.
//
//   dr_i = -min(s u_max dt, dx) dx grad C_i,
//
// where grad C_i is the crowding of concentration.h: Fick's law after Lind et al. (2012), with another weight against
// pairing. The coefficient is that of Skillen et al. (2013), but with the largest speed of the flow instead of the
// particle's own. At a stagnation point the particle's own speed is 0 while the strain aligns particles, which destroys
// a Taylor-Green vortex (docs/theory/closures.md). The minimum keeps this explicit diffusion stable at the long steps
// of the implicit integrator.
//
// Particles keep only a fraction of the shift: 0 wherever the surface is within the support, according to `interior`
// (free_surface.h) of the particle and its neighbours. There the gradient is that of the surface and would drive water
// out of the interior.
//
// Shifts have a smooth bound, dr/sqrt(1 + (dr/cap)^2). Ordinary shifts are a hundredth of dx, and the bound hardly
// changes them. Where two bodies of water meet, a particle has all its neighbours on one side and would otherwise move
// a quarter of dx.
#pragma once

#include <cmath>
#include <span>

#include "closures/surroundings.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

struct ShiftingLaw {
  double strength = 0.0;  ///< s
  double cap = 0.0;       ///< m; upper bound of a shift where particles have the spacing of the case
  double spacing = 0.0;   ///< m; of the case
};

/// Multiplies a shift by the fraction `kept` and bounds it to `cap` [m]. Returns whether the bound was exceeded.
template <int Dim>
bool bound_shift(Vec<Dim>& shift, double kept, double cap) {
  shift *= kept;
  const double ratio = shift.norm() / cap;
  shift /= std::sqrt(1.0 + ratio * ratio);
  return ratio > 1.0;
}

/// Shift [m] of every owned particle (zero for walls); `largest_speed` [m/s] is that of the fluid. Returns the number
/// of shifts that exceeded the bound.
template <int Dim>
std::size_t compute_shift(const ShiftingLaw& law, double dt, double largest_speed, const Pairs<Dim>& pairs,
                          const Particles<Dim>& particles, const Surroundings<Dim>& surroundings,
                          std::span<Vec<Dim>> shift);

}  // namespace tailwater
