#include "porous/porous_law.h"

#include <gtest/gtest.h>

namespace tailwater {
namespace {

constexpr double gravity = 9.81;
constexpr double nu = 1e-6;

PorousTable rock() {
  PorousTable table;
  table.porosity = 0.5;
  table.grain_size = 0.02;
  return table;
}

// With n = 1/2, (1-n)^2/n^3 = 2 and (1-n)/n^3 = 4.
TEST(PorousLaw, FollowsVanGent) {
  const PorousMedium medium = make_medium(rock(), nu, gravity);
  EXPECT_DOUBLE_EQ(medium.linear, 1000.0 * 2.0 * nu / (0.02 * 0.02));
  EXPECT_DOUBLE_EQ(medium.quadratic, 1.1 * 4.0 / 0.02);
  EXPECT_DOUBLE_EQ(medium.porosity(), 0.5);
}

TEST(PorousLaw, WavesRaiseTheQuadraticTerm) {
  PorousTable table = rock();
  const double steady = make_medium(table, nu, gravity).quadratic;
  table.keulegan_carpenter = 15.0;
  EXPECT_DOUBLE_EQ(make_medium(table, nu, gravity).quadratic, 1.5 * steady);
}

// The hydraulic gradient is a v + b v^2, whatever gravity is; the acceleration is g times that.
TEST(PorousLaw, CoefficientsAreThoseOfTheHydraulicGradient) {
  PorousTable table = rock();
  table.resistance = PorousResistance::coefficients;
  table.linear = 3.0;
  table.quadratic = 7.0;
  const PorousMedium medium = make_medium(table, nu, gravity);
  EXPECT_DOUBLE_EQ(medium.linear, 3.0 * gravity);
  EXPECT_DOUBLE_EQ(medium.quadratic, 7.0 * gravity);
}

// A uniform force f on the water in the pores: with the mobility of each step the velocity reaches the one at which
// f = r u for any step, and never passes it.
TEST(PorousLaw, TheMobilityLeadsToTheSteadyVelocityForAnyStep) {
  const PorousMedium medium{.solid = 0.6, .linear = 500.0, .quadratic = 0.0, .added_mass = 0.51};
  constexpr double force = 2.0;
  const double steady = force / medium.rate(0.0);
  for (const double dt : {1e-4, 1e-2, 10.0}) {
    double u = 0.0;
    for (int k = 0; k < 5000; ++k) {
      u = medium.mobility(u, dt) * ((1.0 + medium.added_mass) * u + dt * force);
      ASSERT_LE(u, steady * (1.0 + 1e-12));
    }
    EXPECT_NEAR(u, steady, 1e-9 * steady);
  }
}

}  // namespace
}  // namespace tailwater
