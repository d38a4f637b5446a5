// Water that counts as lost.
#include "results/water_balance.h"

#include <gtest/gtest.h>

#include "case/choices.h"
#include "case/spec.h"
#include "support/pond.h"

namespace tailwater {
namespace {

/// Water 0.4 m deep over a bed from x = 0 to `end`, in a domain with a period of 1 m.
template <int Dim>
CaseSpec periodic_channel(double end, double slope) {
  CaseSpec spec = pond_case<Dim>();
  spec.particles.spacing = 0.04;
  spec.physics.gravity.front() = slope * 9.81;
  spec.domain.periodic_x = {0.0, 1.0};
  spec.fluid[0].max.assign(Dim, 0.4);
  spec.fluid[0].max[0] = 1.0;
  WallTable bed;
  bed.displacement.assign(Dim, 0.0);
  if (Dim == 2) {
    bed.points = {{0.0, 0.0}, {end, 0.0}};
  } else {
    bed.shape = WallShape::box;
    bed.min = {0.0, 0.0, 0.0};
    bed.max = {end, 0.4, 1.0};
    bed.open = {"-x", "+x", "+z"};
  }
  spec.walls.push_back(bed);
  return spec;
}

template <int Dim>
std::int64_t particles_outside(double end, double slope) {
  return water_outside(make_flow<Dim>(periodic_channel<Dim>(end, slope))).particles;
}

TEST(WaterOutside, WhatFallsThroughTheSeamOfAPeriodicDomainComesBack) {
  for (const double slope : {0.0, 0.1, -0.1, 3.0}) {
    EXPECT_EQ(particles_outside<2>(1.0, slope), 0) << slope;
    EXPECT_EQ(particles_outside<3>(1.0, slope), 0) << slope;
  }
}

/// The water has moved beyond the seam of the period and has not yet entered again at the other end.
TEST(WaterOutside, WhatIsBeyondTheSeamWithNoWallBelowItIsInside) {
  CaseSpec spec = periodic_channel<2>(1.0, 0.0);
  spec.physics.gravity = {9.81, 0.0};
  WallTable lid = spec.walls[0];
  lid.points = {{1.0, 0.4}, {0.0, 0.4}};
  spec.walls.push_back(lid);
  Flow<2> flow = make_flow<2>(spec);
  for (Vec<2>& x : flow.state.particles.position) x[0] += 0.03;
  EXPECT_EQ(water_outside(flow).particles, 0);
}

// There are 25 columns of 10 particles. Those beyond the end of the bed, or that gravity moves there, are lost.
TEST(WaterOutside, WhatMissesABedThatEndsIsLost) {
  EXPECT_EQ(particles_outside<2>(0.6, 0.0), 10 * 10);
  EXPECT_EQ(particles_outside<2>(0.6, 0.5), 10 * 10);
  EXPECT_EQ(particles_outside<2>(0.6, -0.5), 10 * 10);
}

}  // namespace
}  // namespace tailwater
