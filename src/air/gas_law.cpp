#include "air/gas_law.h"

#include <cmath>

namespace tailwater {

GasLaw::GasLaw(const AirTable& air)
    : atmosphere(air.pressure), exponent(air.pockets == AirPockets::isothermal ? 1.0 : 1.4) {}

double GasLaw::pressure(double gas, double volume) const {
  return atmosphere * (std::pow(gas / volume, exponent) - 1.0);
}

double GasLaw::slope(double gas, double volume) const {
  return -exponent * atmosphere * std::pow(gas / volume, exponent) / volume;
}

double GasLaw::energy(double gas, double volume) const {
  const double compressed = exponent == 1.0 ? gas * std::log(gas / volume)
                                            : (gas * std::pow(gas / volume, exponent - 1.0) - gas) / (exponent - 1.0);
  return atmosphere * (compressed + volume - gas);
}

double GasLaw::gas(double pressure, double volume) const {
  return volume * std::pow(1.0 + pressure / atmosphere, 1.0 / exponent);
}

}  // namespace tailwater
