// The gas in a pocket. Its amount is given by the volume G that it would have at the pressure of the atmosphere. At the
// volume V its pressure above the atmosphere's is
//
//   P = p_0 ((G/V)^n - 1),
//
// with n = 1.4 for adiabatic and 1 for isothermal gas. The work that the gas can do on its way back to V = G, against
// the atmosphere, is E = int_V^G P dV >= 0: the energy of the gas.
#pragma once

#include "case/spec.h"

namespace tailwater {

struct GasLaw {
  double atmosphere = 101325.0;  ///< Pa; p_0
  double exponent = 1.4;         ///< n

  GasLaw() = default;
  explicit GasLaw(const AirTable& air);

  double pressure(double gas, double volume) const;  ///< Pa
  double slope(double gas, double volume) const;     ///< Pa/m^Dim; dP/dV, below 0
  double energy(double gas, double volume) const;    ///< J
  double gas(double pressure, double volume) const;  ///< m^Dim; amount with this pressure in this volume
};

}  // namespace tailwater
