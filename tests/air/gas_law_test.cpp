#include "air/gas_law.h"

#include <gtest/gtest.h>

namespace tailwater {
namespace {

GasLaw law_of(AirPockets pockets) {
  AirTable air;
  air.pockets = pockets;
  air.pressure = 1e5;
  return GasLaw(air);
}

TEST(GasLaw, HasTheAtmospheresPressureAtItsOwnVolume) {
  for (const AirPockets pockets : {AirPockets::adiabatic, AirPockets::isothermal}) {
    EXPECT_DOUBLE_EQ(law_of(pockets).pressure(0.3, 0.3), 0.0);
    EXPECT_NEAR(law_of(pockets).energy(0.3, 0.3), 0.0, 1e-10);
  }
}

TEST(GasLaw, DoublesAndMoreWhenItIsHalved) {
  EXPECT_NEAR(law_of(AirPockets::isothermal).pressure(2.0, 1.0), 1e5, 1e-9);
  EXPECT_NEAR(law_of(AirPockets::adiabatic).pressure(2.0, 1.0), 1e5 * (std::pow(2.0, 1.4) - 1.0), 1e-9);
}

// Central differences have an error of step^2/6 times the third derivative, 1e-7 of the value here.
TEST(GasLaw, LosesTheWorkThatItDoes) {
  constexpr double step = 1e-4;
  for (const AirPockets pockets : {AirPockets::adiabatic, AirPockets::isothermal}) {
    const GasLaw law = law_of(pockets);
    for (const double volume : {0.5, 0.9, 1.3}) {
      const double energy_slope = (law.energy(1.0, volume + step) - law.energy(1.0, volume - step)) / (2.0 * step);
      const double slope = (law.pressure(1.0, volume + step) - law.pressure(1.0, volume - step)) / (2.0 * step);
      EXPECT_NEAR(energy_slope, -law.pressure(1.0, volume), 1.0);
      EXPECT_NEAR(slope, law.slope(1.0, volume), 1.0);
      EXPECT_GT(law.energy(1.0, volume), 0.0);
    }
  }
}

}  // namespace
}  // namespace tailwater
