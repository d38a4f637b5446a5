// The discharge probe: the mean of its readings equals that of the counted volume, also where the flow bends.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "parts/section_counters.h"
#include "probes/discharge.h"
#include "published/make_flow.h"
#include "schemes/open_ends.h"
#include "schemes/probe_context.h"

namespace tailwater {
namespace {

Row read(const Reading<2>& reading, const Flow<2>& flow) {
  ProbeContext<2> context = context_of(flow);
  context.totals.section_volumes = flow.part<SectionCounters<2>>().volumes();
  return reading.take(context).at(0);
}

/// An upright section at x, from the bed to this height.
ProbeTable section_at(double x, double height) {
  ProbeTable section;
  section.name = "at " + std::to_string(x);
  section.type = ProbeType::discharge;
  section.from = {x, 0.0};
  section.to = {x, height};
  section.direction = {1.0, 0.0};
  return section;
}

/// A supercritical flow falls over the end of its bed; one spacing behind the end it is below the section.
TEST(Discharge, HasTheRightMeanOverABrink) {
  const double depth = 0.2;
  const double speed = 2.0;
  CaseSpec spec = channel<2>(0.6, depth);
  WallTable bed;
  bed.points = {{0.0, 0.0}, {0.6, 0.0}};
  spec.walls = {bed};
  spec.outlets.clear();
  spec.inlets[0].to = {0.0, 0.4};
  spec.inlets[0].discharge = speed * depth;
  spec.inlets[0].level = depth;
  spec.fluid[0].velocity = {speed, 0.0};
  const ProbeTable section = section_at(0.6, 0.4);
  spec.probes = {section};
  Flow<2> flow = make_flow<2>(spec);
  const Reading<2> reading = discharge_reading<2>(section, spec);
  start(flow);
  EXPECT_GE(read(reading, flow)[0], 0.0);
  double sum = 0.0;
  double first_time = 0.0;
  double first_volume = 0.0;
  while (flow.state.time < 3.5) {
    const double before = flow.state.time;
    pass_and_step(flow);
    const Row row = read(reading, flow);
    if (before < 2.0) {  // four times the time of the mean, without the initial flux
      first_time = flow.state.time;
      first_volume = row[1];
      continue;
    }
    sum += (flow.state.time - before) * row[0];
    EXPECT_NEAR(row[0], speed * depth, 0.2 * speed * depth) << "a column in 20 dx/sqrt(g H) = 0.5 s is 5 %";
  }
  const double mean = sum / (flow.state.time - first_time);
  const double counted = (flow.part<SectionCounters<2>>().volumes()[0] - first_volume) / (flow.state.time - first_time);
  EXPECT_NEAR(counted, speed * depth, 0.02 * speed * depth);
  EXPECT_NEAR(mean, counted, 0.02 * counted);
}

/// Water that circulates in a period of 1 m, with a section as high as the water at each end and between the ends.
TEST(Discharge, IsTheSameAtBothEndsOfAPeriodAndBetweenThem) {
  CaseSpec spec = free_case(0.05);
  spec.domain.periodic_x = {0.0, 1.0};
  for (const double y : {0.0, 0.3}) {
    WallTable plate;
    plate.points = {{y == 0.0 ? 0.0 : 1.0, y}, {y == 0.0 ? 1.0 : 0.0, y}};
    spec.walls.push_back(plate);
  }
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.0, 0.3};
  water.velocity = {1.0, 0.0};
  spec.fluid = {water};
  for (const double x : {0.0, 0.52, 1.0}) spec.probes.push_back(section_at(x, 0.3));
  Flow<2> flow = make_flow<2>(spec);
  while (flow.state.time < 2.5) step(flow);
  for (const double volume : flow.part<SectionCounters<2>>().volumes()) {
    EXPECT_NEAR(volume, 0.3 * flow.state.time, 0.3 * 0.05);  // a column of particles
  }
}

/// Rows of a lattice pass the section together, 0.25 s apart, and the mean covers 0.5 s.
TEST(Discharge, DoesNotShowTheRowsOfASlowFlow) {
  constexpr double dx = 0.05, depth = 0.4, speed = 0.2;
  CaseSpec spec = tank_case<2>(dx, 1.0, depth);
  spec.domain.periodic_x = {0.0, 1.0};
  WallTable bed;
  bed.points = {{0.0, 0.0}, {1.0, 0.0}};
  bed.friction = 0.0;
  spec.walls = {bed};
  spec.fluid[0].velocity = {speed, 0.0};
  const ProbeTable section = section_at(0.51, 0.4);
  spec.probes = {section};
  Flow<2> flow = make_flow<2>(spec);
  const Reading<2> reading = discharge_reading<2>(section, spec);
  start(flow);
  while (flow.state.time < 1.5) {
    EXPECT_NEAR(read(reading, flow)[0], speed * depth, 0.05 * speed * depth) << flow.state.time;
    pass_and_step(flow);
  }
}

}  // namespace
}  // namespace tailwater
