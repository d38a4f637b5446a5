// The resistance of a porous layer to the water in its pores. With the filter velocity v = n u, the hydraulic gradient
// of steady flow is
//
//   I = a v + b v |v|
//   a = alpha (1-n)^2/n^3 nu/(g D50^2),   b = beta (1 + 7.5/KC) (1-n)/n^3 1/(g D50)
//
// after van Gent (1995), and with alpha = 150, beta = 1.75 and without KC after Ergun (1952). The resistance to the
// water in the pores is the acceleration g I.
#pragma once

#include "case/spec.h"

namespace tailwater {

/// A porous medium. Every quantity is 0 in open water, and mixes in proportion to the volume of the media.
struct PorousMedium {
  double solid = 0.0;       ///< 1 - n
  double linear = 0.0;      ///< 1/s; g a
  double quadratic = 0.0;   ///< 1/m; g b
  double added_mass = 0.0;  ///< c_A, over the mass of the water

  double porosity() const { return 1.0 - solid; }

  /// Fraction of its acceleration in open water that water with the velocity `speed` [m/s] in the pores keeps in a step
  /// of `dt` [s], when the resistance acts on the velocity at the end of the step: 1/(1 + c_A + r dt) with the rate
  /// r = n (g a + g b n |u|).
  double mobility(double speed, double dt) const { return 1.0 / (1.0 + added_mass + rate(speed) * dt); }
  double rate(double speed) const { return porosity() * (linear + quadratic * porosity() * speed); }  ///< 1/s
};

/// The medium of a layer in water of this kinematic viscosity [m^2/s] under gravity [m/s^2].
PorousMedium make_medium(const PorousTable& table, double viscosity, double gravity);

}  // namespace tailwater
