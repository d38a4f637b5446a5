// Side walls of a channel that is computed in 2D.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "closures/wall_law.h"
#include "parts/side_walls.h"
#include "schemes/cases.h"

namespace tailwater {
namespace {

/// Water that flows everywhere alike, without gravity.
CaseSpec uniform_flow(double speed, double channel_width) {
  CaseSpec spec = periodic_square(0.05);
  spec.physics.viscosity = 1e-6;
  spec.physics.channel_width = channel_width;
  spec.fluid[0].velocity = {speed, 0.0};
  return spec;
}

TEST(SideWalls, StressIsTheMeanOfTheLogarithmicLawOverHalfTheWidth) {
  const double nu = 1e-6;
  const double b = 0.3;
  for (const double roughness : {0.0, 0.002}) {
    const SideWallLaw law{.viscosity = nu, .width = b, .roughness = roughness};
    for (const double u_tau : {0.01, 0.1}) {
      // The mean of u_tau/kappa ln(1 + y/y_0) over y = 0 .. b/2, by the trapezoidal rule.
      const double y_0 = 0.11 * nu / u_tau + roughness / 30.0;
      const int pieces = 200000;
      double mean = 0.0;
      for (int k = 0; k < pieces; ++k) {
        mean += u_tau / von_karman * std::log1p((k + 0.5) / pieces * 0.5 * b / y_0) / pieces;
      }
      EXPECT_NEAR(law.rate(mean) * mean, 2.0 * u_tau * u_tau / b, 1e-4 * u_tau * u_tau / b);
    }
  }
  // Slow water: the two walls of plane Poiseuille flow, whose pressure gradient is 12 nu u/b^2.
  EXPECT_DOUBLE_EQ((SideWallLaw{.viscosity = nu, .width = b}.rate(1e-9)), 12.0 * nu / (b * b));
}

TEST(SideWalls, SlowTheWaterAgainstItsVelocityAndNeverTurnItRound) {
  constexpr double round_off = std::numeric_limits<float>::epsilon();  // pairs are added in single precision
  for (const double width : {0.3, 1e-3, 1e-4, 1e-9}) {                 // the last two bring it to rest within a step
    Flow<2> flow = make_flow<2>(uniform_flow(1.0, width));
    const double dt = next_time_step(flow);
    step(flow);
    const double expected = 1.0 / (1.0 + dt * flow.part<SideWalls<2>>().law().rate(1.0));
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      EXPECT_NEAR(flow.state.particles.velocity[i][0], expected, round_off) << width;
      EXPECT_NEAR(flow.state.particles.velocity[i][1], 0.0, round_off) << width;
    }
  }
}

TEST(SideWalls, AreNoPartOfAFlowWithoutThem) {
  EXPECT_FALSE(has_part<SideWalls<2>>(make_flow<2>(uniform_flow(1.0, 0.0))));
  EXPECT_TRUE(has_part<SideWalls<2>>(make_flow<2>(uniform_flow(1.0, 0.3))));
}

TEST(SideWalls, ThatBringAllWaterToRestWithinAStepAreRefused) {
  CaseSpec spec = tank_case<2>(0.02, 0.4, 0.2);
  spec.physics.viscosity = 1e-6;
  const double dt = 0.55 * 0.02 / std::sqrt(2.0 * g * 0.2);
  const double least = std::sqrt(12e-6 * dt);  // 12 nu/b^2 dt = 1
  spec.physics.channel_width = 1.01 * least;
  EXPECT_NO_THROW(make_flow<2>(spec));
  for (const double width : {0.99 * least, 1e-9}) {
    spec.physics.channel_width = width;
    try {
      const Flow<2> flow = make_flow<2>(spec);
      FAIL() << width << " was taken";
    } catch (const InputError& error) {
      const std::string message = error.what();
      const std::string remedy = fmt::format("give at least {:.3g} m", least);
      for (const std::string& part : {std::string("physics.channel_width = "), remedy}) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
      }
    }
  }
}

}  // namespace
}  // namespace tailwater
