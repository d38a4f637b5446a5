// The laws of viscosity (case/rheology.h).
#include <gtest/gtest.h>

#include <cmath>

#include "rheology/liquids.h"

namespace tailwater {
namespace {

TEST(RheologyLaw, StressIsThatOfEachLaw) {
  const auto stress = [](const LiquidTable& liquid, double rate) { return viscosity_at(liquid, rate) * rate; };
  for (const double rate : {0.5, 2.0, 30.0}) {
    EXPECT_DOUBLE_EQ(stress(newtonian(3.0), rate), 3.0 * rate);
    EXPECT_NEAR(stress(bingham(3.0, 20.0), rate), 20.0 + 3.0 * rate, 1e-12 * 20.0);
    EXPECT_NEAR(stress(herschel_bulkley(3.0, 0.4, 20.0), rate), 20.0 + 3.0 * std::pow(rate, 0.4), 1e-12 * 20.0);
    EXPECT_NEAR(stress(herschel_bulkley(3.0, 0.4, 0.0), rate), 3.0 * std::pow(rate, 0.4), 1e-12);
    EXPECT_NEAR(stress(herschel_bulkley(3.0, 1.5, 0.0), rate), 3.0 * std::pow(rate, 1.5), 1e-9);
  }
}

TEST(RheologyLaw, CarreauGoesFromTheViscosityAtRestToThatAtHighShear) {
  LiquidTable liquid = newtonian(50.0);
  liquid.rheology = Rheology::carreau;
  liquid.high_shear_viscosity = 2.0;
  liquid.relaxation_time = 0.5;
  liquid.index = 0.3;
  EXPECT_DOUBLE_EQ(viscosity_at(liquid, 0.0), 50.0);
  EXPECT_NEAR(viscosity_at(liquid, 2.0), 2.0 + 48.0 * std::pow(2.0, -0.35), 1e-12);  // lambda s = 1
  EXPECT_NEAR(viscosity_at(liquid, 1e12), 2.0, 1e-5);
}

// Stress must rise with the shear rate, or the flow of a given stress would not be unique.
TEST(RheologyLaw, StressRisesWithTheShearRate) {
  for (const LiquidTable& liquid :
       {bingham(1.0, 100.0), herschel_bulkley(5.0, 0.3, 40.0), herschel_bulkley(5.0, 0.3, 0.0)}) {
    double last = 0.0;
    for (double rate = 1e-9; rate < 1e4; rate *= 1.1) {
      const double stress = viscosity_at(liquid, rate) * rate;
      EXPECT_GT(stress, last) << rate;
      last = stress;
    }
  }
}

// At rest the yield stress gives 1000 times the viscosity of flow at which half of the stress is the yield stress.
TEST(RheologyLaw, ViscosityAtRestIsAThousandTimesThatOfFlow) {
  EXPECT_DOUBLE_EQ(default_rest_viscosity(bingham(3.0, 20.0)), 3000.0);
  const double rate = std::pow(20.0 / 3.0, 1.0 / 0.4);  // at which 3 rate^0.4 = 20
  EXPECT_NEAR(default_rest_viscosity(herschel_bulkley(3.0, 0.4, 20.0)), 1000.0 * 20.0 / rate, 1e-9);
  EXPECT_DOUBLE_EQ(viscosity_at_rest(bingham(3.0, 20.0)), 3003.0);
}

}  // namespace
}  // namespace tailwater
