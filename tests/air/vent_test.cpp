#include "air/vent.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tailwater {
namespace vent_law_test {

constexpr double atmosphere = 101325.0;
constexpr double specific = 287.05 * 293.15;  // J/kg; R T of air at 20 degrees Celsius
constexpr double density = atmosphere / specific;

GasLaw law_of(AirPockets pockets) {
  AirTable air;
  air.pockets = pockets;
  air.pressure = atmosphere;
  return GasLaw(air);
}

/// The velocity for the gas of 1 m^3.
double velocity_at(const GasLaw& law, double pressure) { return vent_velocity(law, law.gas(pressure, 1.0), 1.0); }

// Bernoulli's law, with a relative error of the order of P/p_0.
TEST(Vent, LetsOutWhatBernoulliSaysAtSmallPressures) {
  for (const AirPockets pockets : {AirPockets::adiabatic, AirPockets::isothermal}) {
    for (const double pressure : {0.1, 10.0, 1000.0}) {
      const double expected = std::sqrt(2.0 * pressure / density);
      EXPECT_NEAR(velocity_at(law_of(pockets), pressure) / expected, 1.0, 2.0 * pressure / atmosphere);
      EXPECT_NEAR(velocity_at(law_of(pockets), -pressure) / expected, -1.0, 2.0 * pressure / atmosphere);
    }
    EXPECT_EQ(vent_velocity(law_of(pockets), 1.0, 1.0), 0.0);
  }
}

// The mass flux at the speed of sound from textbooks, p_1 sqrt(gamma/(R T_1)) (2/(gamma+1))^((gamma+1)/(2(gamma-1))).
TEST(Vent, IsChokedAtLargePressures) {
  const auto choked = [](double pressure, double temperature_ratio) {
    return pressure * std::sqrt(1.4 / (specific * temperature_ratio)) * std::pow(2.0 / 2.4, 3.0);
  };
  for (const double ratio : {2.0, 5.0}) {
    const double pressure = (ratio - 1.0) * atmosphere;
    const double warm = std::pow(ratio, 0.4 / 1.4);
    EXPECT_NEAR(density * velocity_at(law_of(AirPockets::adiabatic), pressure) / choked(ratio * atmosphere, warm), 1.0,
                1e-12);
    EXPECT_NEAR(density * velocity_at(law_of(AirPockets::isothermal), pressure) / choked(ratio * atmosphere, 1.0), 1.0,
                1e-12);
  }
  for (const double gas : {0.0, 0.1, 0.4}) {  // into a space that is nearly empty, the flow from the atmosphere is
                                              // choked
    EXPECT_NEAR(-density * vent_velocity(law_of(AirPockets::adiabatic), gas, 1.0) / choked(atmosphere, 1.0), 1.0,
                1e-12);
  }
}

TEST(Vent, LetsOutMoreTheHigherThePressure) {
  const GasLaw law = law_of(AirPockets::adiabatic);
  double before = velocity_at(law, -0.6 * atmosphere);
  for (double pressure = -0.59 * atmosphere; pressure < 3.0 * atmosphere; pressure += 0.01 * atmosphere) {
    const double now = velocity_at(law, pressure);
    EXPECT_GE(now, before) << pressure;
    before = now;
  }
}

TEST(Vent, LeavesTheGasThatItsEquationAsksFor) {
  constexpr double dt = 1e-3;
  for (const AirPockets pockets : {AirPockets::adiabatic, AirPockets::isothermal}) {
    const GasLaw law = law_of(pockets);
    for (const double gas : {0.3, 0.99, 1.001, 1.5}) {
      EXPECT_EQ(gas_after_venting(law, gas, 1.0, 0.0, dt), gas);
      for (const double opening : {1e-6, 1e-3, 1.0, 1e3}) {
        const double after = gas_after_venting(law, gas, 1.0, opening, dt);
        // Error of the flow by one rounding of the gas: the flow at the next number above 1.
        const double last_digit = dt * opening * vent_velocity(law, std::nextafter(1.0, 2.0), 1.0);
        EXPECT_NEAR(after + dt * opening * vent_velocity(law, after, 1.0), gas, 4.0 * last_digit + 1e-15);
        EXPECT_LE(std::abs(after - 1.0), std::abs(gas - 1.0)) << "it does not flow past the atmosphere's pressure";
        EXPECT_LE(law.energy(after, 1.0), law.energy(gas, 1.0)) << "nor gains energy";
      }
      EXPECT_NEAR(gas_after_venting(law, gas, 1.0, 1e3, 1e3), 1.0, 1e-9);
    }
  }
}

}  // namespace vent_law_test
}  // namespace tailwater
