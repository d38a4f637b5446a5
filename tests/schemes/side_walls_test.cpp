// Side walls of a channel that is computed in 2D.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
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

TEST(SideWalls, SlowTheWaterAgainstItsVelocityAndNeverTurnItRound) {
  constexpr double round_off = std::numeric_limits<float>::epsilon();  // pairs are added in single precision
  for (const double width : {0.3, 1e-3, 1e-4, 1e-9}) {                 // the last two bring it to rest within a step
    Flow<2> flow = make_flow<2>(uniform_flow(1.0, width));
    const double dt = next_time_step(flow);
    step(flow);
    const double expected = 1.0 / (1.0 + dt * flow.setup.viscosity_law.side_wall_rate(1.0));
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      EXPECT_NEAR(flow.state.particles.velocity[i][0], expected, round_off) << width;
      EXPECT_NEAR(flow.state.particles.velocity[i][1], 0.0, round_off) << width;
    }
  }
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
