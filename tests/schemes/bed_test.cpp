// Beds with a hump whose crest and toes are sharp: still water stays still, a bore passes, no particle is trapped or
// lost.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "schemes/cases.h"

namespace tailwater {
namespace bed_test {

constexpr double dx = 0.02;
constexpr double crest = 0.08;
constexpr double toe = 0.7;
constexpr double half_width_at(double slope) { return crest / slope; }

/// Channel with a symmetric triangular hump of this slope, which continues for `behind` metres after it.
CaseSpec channel_with_hump(double slope, double behind) {
  const double half = half_width_at(slope);
  const double end = toe + 2.0 * half + behind;
  CaseSpec spec;
  spec.particles.spacing = dx;
  WallTable bed;
  bed.points = {{0.0, 0.8}, {0.0, 0.0}, {toe, 0.0}, {toe + half, crest}, {toe + 2.0 * half, 0.0},
                {end, 0.0}, {end, 0.8}};
  spec.walls = {bed};
  return spec;
}

class Hump : public testing::TestWithParam<double> {};

TEST_P(Hump, StillWaterStaysStillAndHydrostatic) {
  const double depth = 0.2;
  CaseSpec spec = channel_with_hump(GetParam(), 0.7);
  FluidTable water;
  water.shape = BlockShape::polygon;
  water.points = spec.walls[0].points;
  water.points.front()[1] = depth;
  water.points.back()[1] = depth;
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  // Rows cut by the slope do not fit the lattice: particles fall to their positions, by less than a spacing.
  const double settling = std::sqrt(2.0 * g * dx);
  while (flow.state.time < 1.0) {
    EXPECT_EQ(step(flow).interventions.stopped_at_walls, 0u);
    ASSERT_LT(measure(flow).largest_speed, settling) << "t = " << flow.state.time;
  }
  const double unit = flow.setup.liquid.density * g * dx;
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    if (!flow.state.particles.is_fluid(i)) continue;
    const Vec<2>& x = flow.state.particles.position[i];
    EXPECT_GT(flow.walls.boundary.nearest(x, 1.0).signed_distance, 0.0);
    // p = 0 is known to dx, and the level to another dx: the area of the polygon differs by up to a particle per row
    // beside the slopes.
    EXPECT_LT(std::abs(flow.state.particles.pressure[i] - flow.setup.liquid.density * g * (depth - x[1])), 2.0 * unit)
        << x.transpose();
  }
}

TEST_P(Hump, ABorePassesAndNobodyIsTrappedOrLost) {
  const double depth = 0.3;
  // The water does not reach the end: the first contact of a film with a wall is not a bore.
  CaseSpec spec = channel_with_hump(GetParam(), 5.0);
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {0.4, depth};
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  const double reservoir = flow.setup.liquid.density * g * depth;
  const double bore = 2.0 * std::sqrt(g * depth);  // at most
  std::size_t stopped_at_walls = 0;
  std::size_t steps = 0;
  // A particle is stopped within the time in which it passes its own length, for any dt: pressures are averaged over
  // this time.
  const double passage = dx / bore;
  double highest_pressure = 0.0;
  double impulse = 0.0;
  double since = 0.0;
  std::size_t beyond = 0;
  for (; flow.state.time < 1.5; ++steps) {
    const StepReport report = step(flow);
    stopped_at_walls += report.interventions.stopped_at_walls;
    double highest_of_step = 0.0;
    beyond = 0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i)) continue;
      const Vec<2>& x = flow.state.particles.position[i];
      ASSERT_GT(flow.walls.boundary.nearest(x, 1.0).signed_distance, 0.0)
          << x.transpose() << ", t = " << flow.state.time;
      highest_of_step = std::max(highest_of_step, flow.state.particles.pressure[i]);
      beyond += x[0] > toe + half_width_at(GetParam());
    }
    impulse += highest_of_step * report.dt;
    since += report.dt;
    if (since >= passage) {
      highest_pressure = std::max(highest_pressure, impulse / since);
      impulse = since = 0.0;
    }
  }
  EXPECT_GT(beyond, 20u);
  // A bore that is stopped and turned back exerts twice its momentum flux, 8 rho g h.
  EXPECT_LT(highest_pressure, 8.0 * reservoir);
  // A particle that lies on a wall is stopped there in every step: no particle does so for a tenth of the run.
  EXPECT_LT(stopped_at_walls, steps / 10);
}

INSTANTIATE_TEST_SUITE_P(Slopes, Hump, testing::Values(0.15, 1.0, std::numbers::sqrt3));

}  // namespace bed_test
}  // namespace tailwater
