// What flows through an opening between a pocket and the atmosphere (docs/theory/air.md). Through an area A with the
// loss coefficient zeta, gas of the pressure p_1 and the density rho_1 upstream flows to p_2 = r p_1 at the rate of
// mass
//
//   m = A/sqrt(zeta) sqrt(2 gamma/(gamma - 1) p_1 rho_1 (r^(2/gamma) - r^((gamma+1)/gamma))),
//
// as from a vessel that keeps its heat (de Saint-Venant & Wantzel 1839), where r is not below the ratio at which the
// flow is at the speed of sound. For small differences of pressure this is m = A sqrt(2 rho dp/zeta).
#pragma once

#include "air/gas_law.h"

namespace tailwater {

/// m/s; the flow of gas, by its volume at the pressure of the atmosphere, over A/sqrt(zeta). Below 0 it comes in.
double vent_velocity(const GasLaw& law, double gas, double volume);

/// m^Dim; what is there of the gas after dt [s], with the flow of the pressure that it then has, through an `opening`
/// A/sqrt(zeta) [m^(Dim-1)] of a pocket that then has this volume.
double gas_after_venting(const GasLaw& law, double gas, double volume, double opening, double dt);

}  // namespace tailwater
