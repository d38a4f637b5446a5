#include "air/vent.h"

#include <algorithm>
#include <cmath>

namespace tailwater {
namespace {

/// gamma of the flow, which is adiabatic for any law of the gas in the pocket.
constexpr double heat_ratio = 1.4;

/// J/kg; p/rho of dry air at 20 degrees Celsius.
constexpr double pressure_over_density = 287.05 * 293.15;

/// Minimum of G/V - 1. That flow is choked, and less gas gives the same flow.
constexpr double min_excess = -0.999;

/// Number of bisections, to the last digit.
constexpr int halvings = 60;

}  // namespace

// With x = ln(G/V) pressures are p_0 exp(n x) and p_0, densities rho_0 exp(x) and rho_0.
double vent_velocity(const GasLaw& law, double gas, double volume) {
  const double max_fall = heat_ratio / (heat_ratio - 1.0) * std::log(0.5 * (heat_ratio + 1.0));  // of ln p
  const double x = std::log1p(std::max((gas - volume) / volume, min_excess));
  const double fall = std::min(law.exponent * std::abs(x), max_fall);
  const double square = 2.0 * heat_ratio / (heat_ratio - 1.0) * pressure_over_density *
                        std::exp((law.exponent + 1.0) * std::max(x, 0.0) - 2.0 / heat_ratio * fall) *
                        -std::expm1(-(heat_ratio - 1.0) / heat_ratio * fall);
  return std::copysign(std::sqrt(square), x);
}

// The more gas is left, the more flows out. So there is one solution, between the present gas and that without flow.
double gas_after_venting(const GasLaw& law, double gas, double volume, double opening, double dt) {
  if (opening == 0.0) return gas;
  double low = std::min(gas, volume);
  double high = std::max(gas, volume);
  for (int k = 0; k < halvings; ++k) {
    const double middle = 0.5 * (low + high);
    const bool is_too_much = middle + dt * opening * vent_velocity(law, middle, volume) > gas;
    (is_too_much ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace tailwater
