// The flow through an opening between a pocket and the atmosphere (docs/theory/air.md). Gas of the pressure p_1 and the
// density rho_1 upstream flows through an area A with the loss coefficient zeta to p_2 = r p_1 at the mass rate
//
//   m = A/sqrt(zeta) sqrt(2 gamma/(gamma - 1) p_1 rho_1 (r^(2/gamma) - r^((gamma+1)/gamma))),
//
// as from an adiabatic vessel (de Saint-Venant & Wantzel 1839), where r is not below the ratio at which the flow is at
// the speed of sound. For small differences of pressure this is m = A sqrt(2 rho dp/zeta).
#pragma once

#include "air/gas_law.h"

namespace tailwater {

/// m/s; flow of gas, by its volume at the pressure of the atmosphere, over A/sqrt(zeta). Negative for inflow.
double vent_velocity(const GasLaw& law, double gas, double volume);

/// m^Dim; the gas left after dt [s], with the flow of its pressure at that time, through an `opening` A/sqrt(zeta)
/// [m^(Dim-1)] of a pocket that then has this volume.
double gas_after_venting(const GasLaw& law, double gas, double volume, double opening, double dt);

}  // namespace tailwater
