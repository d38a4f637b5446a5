// Eddy viscosity of boundary layers after Spalart & Allmaras (1992), carried by the particles:
//
//   D nu~/Dt = c_b1 S nu~ + [div((nu + nu~) grad nu~) + c_b2 |grad nu~|^2]/sigma - c_w1 f_w (nu~/d)^2,
//   nu_t = nu~ f_v1(nu~/nu),
//
// with the distance d from the nearest wall that has friction. Differences from the original model:
//
//   - A layer begins at walls only. Where the stress on a wall is turbulent, nu~ is at least that of the thinnest layer
//     (`seed`). Water that no layer has reached keeps nu~ = 0.
//   - A layer thinner than dx is represented by its thickness. With the parabola kappa u_tau y (1 - y/delta), whose
//     maximum is nu~, delta = 4 nu~/(kappa u_tau). The wall law then uses the outer speed at the distance delta.
//     Production makes the layer grow by d delta/dt = c_b1/kappa u_tau; the momentum balance requires kappa u_tau.
//   - Beside a wall S = u_tau/(kappa d), as in the logarithmic layer. Elsewhere S is the smaller of the rates of
//     rotation and strain: both are equal in a layer; the smaller one is 0 in potential flow and in a vortex.
//   - The term f_t2 and the trip term are omitted, and no flux crosses the wall, where nu~ = 0.
//   - For a rough wall, d is measured from 0.03 k_s behind the wall (Aupoix & Spalart 2003).
#pragma once

#include <algorithm>
#include <cmath>

#include "closures/wall_law.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

namespace spalart_allmaras {

inline constexpr double c_b1 = 0.1355;
inline constexpr double c_b2 = 0.622;
inline constexpr double sigma = 2.0 / 3.0;
inline constexpr double c_w1 = c_b1 / (von_karman * von_karman) + (1.0 + c_b2) / sigma;
inline constexpr double c_w2 = 0.3;
inline constexpr double c_w3 = 2.0;
inline constexpr double c_v1 = 7.1;

/// y u_tau/nu of the thinnest turbulent layer: just beyond 11.33, where the two laws of a smooth wall meet.
inline constexpr double thinnest_layer = 11.4;

/// 1/f_v1 as a function of nu/nu~.
inline double damping(double chi_inverse) { return 1.0 + std::pow(c_v1 * chi_inverse, 3); }

/// nu_t [m^2/s] for nu~ in water with viscosity `molecular` [m^2/s].
inline double eddy_viscosity(double layer_viscosity, double molecular) {
  return layer_viscosity == 0.0 ? 0.0 : layer_viscosity / damping(molecular / layer_viscosity);
}

/// nu~ [m^2/s] of the thinnest turbulent layer on a wall.
inline double seed(const WallLaw& wall, double friction_velocity) {
  return 0.25 * von_karman * (thinnest_layer * wall.viscosity + friction_velocity * wall.roughness);
}

/// Thickness [m] of a layer thinner than dx.
inline double thickness(double layer_viscosity, double friction_velocity) {
  return 4.0 * layer_viscosity / (von_karman * friction_velocity);
}

/// S~ [1/s] of water at the distance d [m] where the resolved rate is `S` [1/s].
inline double modified_rate(double S, double layer_viscosity, double molecular, double d) {
  const double chi_inverse = molecular / layer_viscosity;
  const double f_v2 = 1.0 - 1.0 / (chi_inverse + 1.0 / damping(chi_inverse));
  const double near = layer_viscosity * f_v2 / std::pow(von_karman * d, 2);
  return std::max(0.3 * S, S + near);
}

/// c_w1 f_w nu~/d^2 [1/s]: the relative rate at which the wall reduces nu~. `S` is the modified rate.
inline double destruction_rate(double S, double layer_viscosity, double d) {
  const double largest = 10.0;
  const double scale = S * std::pow(von_karman * d, 2);
  const double r = layer_viscosity < largest * scale ? layer_viscosity / scale : largest;
  const double g = r + c_w2 * (std::pow(r, 6) - r);
  const double f_w = g * std::pow((1.0 + std::pow(c_w3, 6)) / (std::pow(g, 6) + std::pow(c_w3, 6)), 1.0 / 6.0);
  return c_w1 * f_w * layer_viscosity / (d * d);
}

/// Viscosity [m^2/s] with which the diffusion of nu~ enters the limit of the time step.
inline double diffusivity(double layer_viscosity) { return (1.0 + c_b2) / sigma * layer_viscosity; }

/// The diffusion term [m^2/s^2] of fluid particle i, over fluid neighbours. c_b2 |grad nu~|^2 is written as
/// div((1 + c_b2)(nu + nu~) grad nu~) - c_b2 (nu + nu~) lap nu~, whose two-point weights are never negative.
template <int Dim>
double diffusion(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double molecular, double spacing,
                 std::size_t i);

}  // namespace spalart_allmaras

/// The smaller of the rates of rotation sqrt(2 W:W) and of strain sqrt(2 S:S) [1/s] of a velocity gradient.
template <int Dim>
double shear_rate(const Mat<Dim>& gradient) {
  const Mat<Dim> transposed = gradient.transpose();
  return std::sqrt(0.5 * std::min((gradient - transposed).squaredNorm(), (gradient + transposed).squaredNorm()));
}

}  // namespace tailwater
