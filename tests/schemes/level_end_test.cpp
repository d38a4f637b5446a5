// Open ends that hold a level, and the flow through them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "case/formulation.h"
#include "case/reader.h"
#include "published/make_flow.h"
#include "schemes/open_ends.h"

namespace tailwater {
namespace level_end_test {

constexpr double dx = end_spacing;

/// Mean depth [m] of the water in a 2D channel or tank of this length. Each particle is a cell as wide as a column;
/// only the part of the cell inside the channel counts.
double mean_depth(const Flow<2>& flow, double length) {
  const Particles<2>& particles = flow.state.particles;
  double volume = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double x = particles.position[i][0];
    const double inside = std::min(x, length - x) / dx + 0.5;
    volume += std::clamp(inside, 0.0, 1.0) * particles.volume[i];
  }
  return volume / length;
}

/// Depth [m] of the water in the half of a tank away from its open end. The weight counts columns of particles evenly:
/// 1 near the closed end, then linearly down to 0 in the middle.
template <int Dim>
double depth_away_from_end(const Flow<Dim>& flow) {
  const OpenEnd<Dim>& end = flow.template part<OpenEnds<Dim>>().ends()[0];
  const Particles<Dim>& particles = flow.state.particles;
  double volume = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const double from_wall = 1.0 + end.opening.beyond(particles.position[i]) / end.reach;
    if (particles.is_fluid(i)) volume += particles.volume[i] * std::clamp((0.5 - from_wall) / 0.4, 0.0, 1.0);
  }
  return volume / (0.3 * end.reach * end.width);
}

constexpr double tank_width = 0.6;  // m

/// The tank of open_tank<2> with a level beyond its open end, which lets the waves of the start out.
CaseSpec tank_with_level(double depth, const Varying& level) {
  CaseSpec spec = open_tank<2>(tank_width, depth);
  spec.walls[0].max[1] = spec.outlets[0].to[1] = 1.2;
  spec.outlets[0].level = level;
  spec.outlets[0].absorbing = 0.3;
  return spec;
}

/// m/s; mean velocity through a laminar conduit 0.1 m high and 0.3 m long after 1.5 s, between levels that differ by
/// 5 mm.
double speed_in_conduit(double level) {
  CaseSpec spec = tank_case<2>(0.0125, 0.3, 0.1);
  spec.walls[0].max[1] = 0.1;
  spec.walls[0].open.clear();
  spec.walls[0].slip = Slip::no_slip;
  spec.physics.viscosity = 2e-3;
  open_end(spec).level = level;
  open_start(spec).level = level + 0.005;
  Flow<2> flow = make_flow<2>(spec);
  double speed = 0.0;
  double steps = 0.0;
  start(flow);
  while (flow.state.time < 1.5) {
    pass_and_step(flow);
    if (flow.state.time < 1.2) continue;
    const Particles<2>& particles = flow.state.particles;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < particles.owned; ++i) {
      const double x = particles.position[i][0];
      if (!particles.is_fluid(i) || x < 0.1 || x > 0.2) continue;
      sum += particles.velocity[i][0];
      count += 1.0;
    }
    speed += sum / count;
    steps += 1.0;
  }
  return speed / steps;
}

/// Only the pressure between its openings drives water that fills a conduit.
TEST(FullConduit, DoesNotFeelTheLevelOfItsPressure) {
  const double low = speed_in_conduit(0.13);
  EXPECT_NEAR(low, 0.065, 0.1 * 0.065);  // 0.068 of theory, less the head of this velocity
  EXPECT_NEAR(speed_in_conduit(1.0), low, 0.03 * low);
}

/// An end without flow holds its level from both sides: a tank fills or empties to the level from any initial depth,
/// and stays there. The waves of the filling are left at 0.7 to 1.03 dx from 5 s on, by rounding: the mean counts.
TEST(OpenEnd, ATankComesToTheLevelBeyond) {
  for (const double level : {0.25, 0.8}) {
    Flow<2> flow = make_flow<2>(tank_with_level(0.5, level));
    start(flow);
    double sum = 0.0, time = 0.0;
    while (flow.state.time < 8.0) {
      const double before = flow.state.time;
      pass_and_step(flow);
      if (flow.state.time < 6.0) continue;
      sum += (flow.state.time - before) * mean_depth(flow, tank_width);
      time += flow.state.time - before;
    }
    EXPECT_NEAR(sum / time, level, 0.5 * dx);
    EXPECT_LT(state_of_end(flow, 0).miss.since, 0.0) << "not missed for long";
  }
}

/// An initially dry tank also fills to the level beyond.
TEST(OpenEnd, ADryTankFillsToTheLevelBeyond) {
  CaseSpec spec = tank_with_level(0.5, 0.4);
  spec.fluid.clear();
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 7.0) {
    pass_and_step(flow);
    if (flow.state.time > 5.0) {
      ASSERT_NEAR(mean_depth(flow, tank_width), 0.4, dx) << "t = " << flow.state.time;
    }
  }
}

/// Runs a tank beside an end whose level changes by at most `rate` [m/s] for `duration` and then rests. The lag of the
/// depth has three parts, each at most u c/g = r L/c, where u = r L/h is the flow that enters. They are the slope that
/// drives this flow, the rise of the level during the response of the tank, L/c, and the averaging of the end over the
/// time L/c. The depth equals the level after it has come to rest.
template <int Dim>
void expect_follows(const CaseSpec& spec, const Varying& level, double rate, double duration, double at_rest) {
  CaseSpec with_level = spec;
  (spec.inlets.empty() ? with_level.outlets[0].level : with_level.inlets[0].level) = level;
  Flow<Dim> flow = make_flow<Dim>(with_level);
  start(flow);
  const double length = flow.template part<OpenEnds<Dim>>().ends()[0].reach;
  const TimeFunction asked(level, {});
  double least = asked.at(0.0);  // m; lowest level so far
  while (flow.state.time < duration) {
    pass_and_step(flow);
    const double now = asked.at(flow.state.time);
    least = std::min(least, now);
    const double lag = 3.0 * rate * length / std::sqrt(g * least);
    ASSERT_NEAR(depth_away_from_end(flow), now, lag + dx) << "t = " << flow.state.time;
  }
  const double calm = duration + 8.0 * length / std::sqrt(g * at_rest);
  double mean = 0.0;
  int count = 0;
  while (flow.state.time < calm + 3.0) {
    pass_and_step(flow);
    if (flow.state.time < calm) continue;
    mean += depth_away_from_end(flow);
    ++count;
  }
  EXPECT_NEAR(mean / count, at_rest, 0.3 * dx);
  EXPECT_LT(state_of_end(flow, 0).miss.since, 0.0) << "not missed for long";
}

/// The water follows any series of levels: up, down, and as a wave.
TEST(OpenEnd, ATankFollowsAnySeriesOfLevels) {
  const CaseSpec spec = tank_with_level(0.5, 0.5);
  expect_follows<2>(spec, Varying("0.5 + 0.3*min(1, t/3)"), 0.1, 3.0, 0.8);
  expect_follows<2>(spec, Varying("0.5 - 0.2*min(1, t/2)"), 0.1, 2.0, 0.3);
  expect_follows<2>(spec, Varying("0.5 + 0.1*sin(1.5*min(t, 8*atan(1)/1.5))"), 0.15, 6.0, 0.5);
}

/// A level that steps during a run, up and far down, with an end that absorbs waves. The tank overshoots, returns to
/// the level within three seconds, about six travel times of a wave through the tank, and stays.
TEST(OpenEnd, ATankComesToALevelThatSteps) {
  const TimeFunction asked(Varying("t < 1 ? 0.5 : t < 5.5 ? 0.7 : 0.4"), {});
  CaseSpec spec = tank_with_level(0.5, Varying("t < 1 ? 0.5 : t < 5.5 ? 0.7 : 0.4"));
  spec.outlets[0].absorbing = 1.0;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 10.0) {
    pass_and_step(flow);
    const double t = flow.state.time;
    const bool is_calm = t < 1.0 || (t > 4.0 && t < 5.5) || t > 8.5;
    if (is_calm) {
      ASSERT_NEAR(depth_away_from_end(flow), asked.at(t), dx) << "t = " << t;
    }
  }
}

/// The opening may end just above the water, and water may enter from either side.
TEST(OpenEnd, ATankFollowsWhateverTheOpening) {
  const Varying rise("0.4 + 0.3*min(1, t/3)");
  CaseSpec spec = tank_with_level(0.4, 0.4);
  spec.outlets[0].to[1] = 0.75;
  expect_follows<2>(spec, rise, 0.1, 3.0, 0.7);
  CaseSpec from_left = channel<2>(tank_width, 0.4);
  from_left.walls[0].open = {"+y", "-x"};
  from_left.walls[0].max[1] = from_left.inlets[0].to[1] = 1.2;
  from_left.outlets.clear();
  expect_follows<2>(from_left, rise, 0.1, 3.0, 0.7);
}

/// Both integrators of scheme F and scheme B hold the level, also in 3D.
TEST(OpenEnd, ATankFollowsWithEveryFormulation) {
  const Varying rise("0.4 + 0.2*min(1, t/2)");
  CaseSpec spec = tank_with_level(0.4, 0.4);
  spec.scheme.integrator = Integrator::explicit_projection;
  expect_follows<2>(spec, rise, 0.1, 2.0, 0.6);
  CaseSpec two_step = tank_with_level(0.4, 0.4);
  two_step.scheme.name = SchemeName::farmani2020;
  apply_formulation(two_step.scheme);
  expect_follows<2>(two_step, rise, 0.1, 2.0, 0.6);
}

TEST(OpenEnd, ATankFollowsIn3D) {
  CaseSpec spec = open_tank<3>(0.4, 0.3);
  spec.fluid[0].max[1] = spec.walls[0].max[1] = spec.outlets[0].to[1] = 4.0 * dx;
  spec.walls[0].max[2] = spec.outlets[0].to[2] = 0.6;
  expect_follows<3>(spec, Varying("0.3 + 0.1*min(1, t)"), 0.1, 1.0, 0.4);
}

/// A channel whose discharge ends keeps its tailwater. The deceleration of the water, u/T, tilts the surface by u L/(g
/// T), half of it on average. When the deceleration ends, the surface swings by as much to the other side. The mean
/// depth therefore differs by at most this tilt and a spacing.
TEST(OpenEnd, AChannelWhoseDischargeEndsKeepsItsTailwater) {
  const double length = 2.0;
  const double depth = 0.3;
  const double speed = 0.5;
  const double duration = 3.0;
  CaseSpec spec = channel<2>(length, depth);
  spec.fluid[0].velocity = {speed, 0.0};
  spec.inlets[0].discharge = Varying(fmt::format("{}*max(0, 1 - t/{})", speed * depth, duration));
  spec.outlets[0].level = depth;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  double mean = 0.0;
  int count = 0;
  while (flow.state.time < 12.0) {
    pass_and_step(flow);
    const double now = mean_depth(flow, length);
    ASSERT_NEAR(now, depth, speed * length / (g * duration) + dx) << "t = " << flow.state.time;
    if (flow.state.time < duration) continue;
    mean += now;
    ++count;
  }
  EXPECT_NEAR(mean / count, depth, 0.5 * dx);
}

/// Without a level the channel continues: a change of the discharge sends a simple wave down the channel, which leaves.
/// Behind the wave u - 2 sqrt(g h) is unchanged, to the resolution of a level, half a spacing. The error is 0.35 dx,
/// and half of that with half the spacing.
TEST(OpenEnd, AChannelThatGoesOnTakesADischargeThatChanges) {
  const double length = 1.5;
  const double depth = 0.4;
  for (const auto& [before, after] : {std::pair{0.0, 0.45}, {0.5, 0.0}}) {  // m/s
    const double celerity = std::sqrt(g * depth) + 0.5 * (after - before);
    const double depth_after = celerity * celerity / g;
    CaseSpec spec = channel<2>(length, depth);
    spec.fluid[0].velocity = {before, 0.0};
    spec.inlets[0].discharge =
        Varying(fmt::format("{0} + ({1} - {0})*min(1, t/2)", before * depth, after * depth_after));
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    while (flow.state.time < 8.0) {
      pass_and_step(flow);
      if (flow.state.time > 3.5) {
        ASSERT_NEAR(mean_depth(flow, length), depth_after, 0.5 * dx) << "t = " << flow.state.time;
      }
    }
  }
}

/// Potential flow from water at rest over a free brink is critical: two thirds of the head deep, q = (2/3)^1.5 sqrt(g)
/// H^1.5. A column of particles is half a percent of the counted volume.
TEST(OpenEnd, AReservoirGivesTheDischargeOfPotentialFlow) {
  const double head = 10.0 * dx;
  CaseSpec spec = channel<2>(1.5, head);
  spec.walls[0].max[1] = spec.inlets[0].to[1] = spec.outlets[0].to[1] = 1.0;
  spec.fluid.clear();
  spec.inlets[0].level = head;
  spec.inlets[0].absorbing = 0.0;
  spec.outlets[0].level = 0.0;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 2.0) pass_and_step(flow);
  const double at_start = arrived_at(flow, 0).volume;
  while (flow.state.time < 8.0) pass_and_step(flow);
  const double discharge = (arrived_at(flow, 0).volume - at_start) / 6.0;
  EXPECT_NEAR(discharge / (std::pow(2.0 / 3.0 * head, 1.5) * std::sqrt(g)), 1.0, 0.01);
}

/// In linear theory, a tank that is D below a fixed level beyond its open end rises by 2 D. This takes the time 2 L/c,
/// half a period; the tank is back after 4 L/c. Entrance losses reduce the rise. An absorbing level lets the wave out:
/// the tank is at the level by then and stays.
TEST(OpenEnd, AHeldLevelReflectsAndAnAbsorbingOneDoesNot) {
  const double length = 2.0;
  const double above = 2.0 * dx;
  for (const double absorbing : {0.0, 1.0}) {
    CaseSpec spec = open_tank<2>(length, 0.5);
    spec.walls[0].max[1] = spec.outlets[0].to[1] = 1.2;
    spec.outlets[0].level = 0.5 + above;
    spec.outlets[0].absorbing = absorbing;
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    const double pass = length / std::sqrt(g * (0.5 + above));
    while (flow.state.time < 2.0 * pass) pass_and_step(flow);
    const double at_half_period = mean_depth(flow, length);
    while (flow.state.time < 4.0 * pass) pass_and_step(flow);
    const double at_period = mean_depth(flow, length);
    if (absorbing == 0.0) {
      EXPECT_NEAR(at_half_period, 0.5 + 1.75 * above, 0.25 * above);
      EXPECT_NEAR(at_period, 0.5 + 0.25 * above, 0.5 * above);
    } else {
      EXPECT_NEAR(at_half_period, 0.5 + above, 0.5 * dx);
      EXPECT_NEAR(at_period, 0.5 + above, 0.5 * dx);
    }
  }
}

/// A river that flows into a rising sea fills its reach to the level of the sea, and no water accumulates at its end.
TEST(OpenEnd, ARiverRunsIntoARisingSea) {
  const double length = 2.0;
  const double depth = 0.4;
  for (const Integrator integrator : {Integrator::explicit_projection, Integrator::implicit_projection}) {
    CaseSpec spec = channel<2>(length, depth);
    spec.scheme.integrator = integrator;
    spec.fluid[0].velocity = {0.2, 0.0};
    spec.inlets[0].discharge = 0.2 * depth;
    spec.outlets[0].level = Varying("0.4 + 0.03*min(t, 3)");  // three quarters of the discharge fill the reach
    spec.outlets[0].absorbing = 0.0;
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    while (flow.state.time < 5.0) {
      pass_and_step(flow);
      ASSERT_LT(measure(flow).density_error_rms, 0.02) << "t = " << flow.state.time;
    }
    EXPECT_NEAR(mean_depth(flow, length), 0.49, dx);
    const OpenEnd<2>& end = flow.part<OpenEnds<2>>().ends()[1];
    double in_buffer = 0.0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      const bool counts = flow.state.particles.is_fluid(i) && end.holds(flow.state.particles.position[i]);
      if (counts) in_buffer += flow.state.particles.volume[i];
    }
    EXPECT_NEAR(in_buffer / (0.49 * end.stretch), 1.0, 0.15) << "a column is a quarter, its half an eighth";
  }
}

/// Two layers with opposite velocities leave and enter through the same openings. The shear between them mixes a third
/// of each within the time; a buffer zone with a single velocity would let nothing pass.
TEST(OpenEnd, LayersPassInOppositeDirections) {
  const double speed = 0.5;
  const double depth = 0.4;
  CaseSpec spec = channel<2>(1.5, 2.0 * depth);
  spec.walls[0].max[1] = spec.inlets[0].to[1] = spec.outlets[0].to[1] = 1.2;
  spec.fluid[0].max[1] = depth;
  spec.fluid[0].velocity = {speed, 0.0};
  FluidTable upper = spec.fluid[0];
  upper.name = "upper";
  upper.min[1] = depth;
  upper.max[1] = 2.0 * depth;
  upper.velocity = {-speed, 0.0};
  spec.fluid.push_back(upper);
  spec.inlets[0].level = spec.outlets[0].level = 2.0 * depth;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 1.0) pass_and_step(flow);
  const double layer = speed * depth * flow.state.time;
  for (const std::size_t end : {0, 1}) {
    EXPECT_NEAR(arrived_at(flow, end).volume / layer, 0.8, 0.25) << "end " << end;
    EXPECT_NEAR(state_of_end(flow, end).departed.volume / layer, 0.8, 0.25) << "end " << end;
  }
}

/// A tank behind a full pipe or shaft, below the level beyond: the tank reaches that level, from above or below, for
/// any position of the opening.
TEST(OpenEnd, ATankComesToTheLevelBeyondAFullSection) {
  const std::string pipe =
      "[[wall]]\npoints = [[0, 1], [0, 0], [1.1, 0]]\n[[wall]]\npoints = [[1.1, 0.2], [0.6, 0.2], [0.6, 1]]\n"
      "[[fluid]]\nmin = [0.6, 0]\nmax = [1.1, 0.2]\n"
      "[[outlet]]\nfrom = [1.1, 0]\nto = [1.1, 0.2]\nlevel = 0.4\n";
  const std::string shaft =
      "[[wall]]\npoints = [[0, 1], [0, 0], [0.2, 0], [0.2, -0.5]]\n[[wall]]\npoints = [[0.4, -0.5], [0.4, 0], [0.6, "
      "0], "
      "[0.6, 1]]\n[[fluid]]\nmin = [0.2, -0.5]\nmax = [0.4, 0]\n"
      "[[outlet]]\nfrom = [0.2, -0.5]\nto = [0.4, -0.5]\ndirection = [0, -1]\nlevel = 0.4\n";
  for (const std::string& way : {pipe, shaft}) {
    for (const double depth : {0.3, 0.5}) {
      const std::string start_of_case =
          fmt::format("particles.spacing = 0.05\ntime.end = 9\n[[fluid]]\nmin = [0, 0]\nmax = [0.6, {}]\n", depth);
      Flow<2> flow = make_flow<2>(read_case_text(start_of_case + way, "case.toml"));
      start(flow);
      double mean = 0.0;
      int count = 0;
      while (flow.state.time < 6.0) {
        pass_and_step(flow);
        if (flow.state.time < 3.0) continue;
        const Particles<2>& particles = flow.state.particles;
        for (std::size_t i = 0; i < particles.owned; ++i) {
          const Vec<2>& x = particles.position[i];
          if (particles.is_fluid(i) && x[0] < 0.6 && x[1] > 0.0) mean += particles.volume[i] / 0.6;
        }
        ++count;
      }
      EXPECT_NEAR(mean / count, 0.4, dx) << way << " depth " << depth;
    }
  }
}

/// Water in a full duct 2 m long, between levels that differ by 0.05 m, is accelerated as a column of its length, to
/// half a spacing at each mouth. A buffer that is a step late costs 11 % of the speed in this time.
TEST(OpenEnd, AFullDuctIsAcceleratedAsAColumnOfItsLength) {
  Flow<2> flow = make_flow<2>(read_case_text(
      "particles.spacing = 0.05\ntime.end = 1\npressure_solver.tolerance = 1e-8\n"
      "[[fluid]]\nmin = [0, 0]\nmax = [2, 0.3]\n"
      "[[wall]]\npoints = [[0, 0], [2, 0]]\n[[wall]]\npoints = [[2, 0.3], [0, 0.3]]\n"
      "[[inlet]]\nfrom = [0, 0]\nto = [0, 0.3]\nlevel = 0.65\n[[outlet]]\nfrom = [2, 0]\nto = [2, 0.3]\nlevel = 0.6\n",
      "case.toml"));
  start(flow);
  while (flow.state.time < 0.35) pass_and_step(flow);
  const Particles<2>& particles = flow.state.particles;
  double momentum = 0.0, volume = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i) || std::abs(particles.position[i][0] - 1.0) > 0.5) continue;
    momentum += particles.volume[i] * particles.velocity[i][0];
    volume += particles.volume[i];
  }
  EXPECT_NEAR(momentum / volume / (g * 0.05 / 2.0 * flow.state.time), 1.0, dx / 2.0);
}

/// A stage-discharge relation: the level is a function of the discharge that leaves, so a given inflow reaches its
/// level.
TEST(OpenEnd, AStageDischargeRelationFindsItsLevel) {
  const double discharge = 0.2;
  CaseSpec spec = channel<2>(1.5, 0.4);
  spec.walls[0].max[1] = spec.inlets[0].to[1] = spec.outlets[0].to[1] = 1.0;
  spec.inlets[0].discharge = discharge;
  spec.outlets[0].level = Varying("0.3 + q");
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 10.0) pass_and_step(flow);
  EXPECT_NEAR(mean_depth(flow, 1.5), 0.3 + discharge, 0.5 * dx);
  EXPECT_NEAR(state_of_end(flow, 1).mean_discharge, discharge, 0.05 * discharge);
}

/// A wave of 0.2 to 0.6 m2/s, much shorter than twice the time in which a long wave passes through the channel, reaches
/// a rating curve: level and discharge before the outlet belong together at each instant. Half a spacing more of the
/// arriving wave makes up to (1 + c f') times that between level and curve.
TEST(OpenEnd, AStageDischargeRelationHoldsInUnsteadyFlow) {
  for (const double slope : {0.3, 0.6, 2.0}) {
    const auto level_at = [&](double q) { return 0.32 + slope * (q - 0.2); };
    Flow<2> flow = make_flow<2>(read_case_text(
        fmt::format("particles.spacing = 0.04\ntime.end = 6\n"
                    "[[fluid]]\nmin = [0, 0]\nmax = [4, 0.32]\nvelocity = [0.625, 0]\n"
                    "[[wall]]\npoints = [[0, 0], [4, 0]]\n"
                    "[[inlet]]\nfrom = [0, 0]\nto = [0, 1.5]\ndischarge = \"0.2 + 0.4*exp(-((t - 2)/0.8)^2)\"\n"
                    "[[outlet]]\nfrom = [4, 0]\nto = [4, 1.5]\nlevel = \"0.32 + {}*(q - 0.2)\"\n",
                    slope),
        "case.toml"));
    start(flow);
    double depth = 0.32, discharge = 0.2, highest = 0.0, largest_error = 0.0, time = 0.0;
    while (time < 6.0) {
      pass_and_step(flow);
      const double share = 1.0 - std::exp(-(flow.state.time - time) / 0.25);
      time = flow.state.time;
      double volume = 0.0, moved = 0.0;
      const Particles<2>& particles = flow.state.particles;
      for (std::size_t i = 0; i < particles.owned; ++i) {
        if (!particles.is_fluid(i) || std::abs(particles.position[i][0] - 3.9) > 0.1) continue;
        volume += particles.volume[i] / 0.2;
        moved += particles.volume[i] * particles.velocity[i][0] / 0.2;
      }
      depth += share * (volume - depth);
      discharge += share * (moved - discharge);
      highest = std::max(highest, depth);
      if (time > 1.0) largest_error = std::max(largest_error, std::abs(depth - level_at(discharge)));
    }
    const double celerity = std::sqrt(g * highest);
    EXPECT_LT(largest_error, 0.5 * 0.04 * (1.0 + celerity * slope)) << slope;
    EXPECT_GT(highest, 0.32 + 0.5 * slope * 0.4 / (1.0 + slope)) << slope;
  }
}

/// Where water enters, the discharge of a relation is 0: many have no value below it. The surface of still water, with
/// its tremble, stays level.
TEST(OpenEnd, AStageDischargeRelationNeedsNoNegativeDischarges) {
  for (const double absorbing : {0.0, 0.3}) {
    CaseSpec spec = tank_with_level(0.35, Varying("0.4 + sqrt(q)"));
    spec.outlets[0].absorbing = absorbing;
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    while (flow.state.time < 3.0) pass_and_step(flow);
    EXPECT_NEAR(mean_depth(flow, tank_width), 0.4, dx);
  }
}

/// A supercritical flow passes below a tailwater that is too low to dam it: the level is missed, and the run reports
/// it.
TEST(OpenEnd, ALevelThatIsNotHeldIsTold) {
  const double depth = 0.2;
  const double speed = 4.0;
  CaseSpec spec = channel<2>(1.0, depth);
  spec.walls[0].max[1] = spec.inlets[0].to[1] = spec.outlets[0].to[1] = 0.8;
  spec.fluid[0].velocity = {speed, 0.0};
  spec.inlets[0].discharge = speed * depth;
  spec.inlets[0].level = depth;
  spec.outlets[0].level = 0.4;  // the conjugate depth is 0.72 m
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 6.0) pass_and_step(flow);
  const LevelError& miss = state_of_end(flow, 1).miss;
  EXPECT_GE(miss.since, 0.0);
  EXPECT_NEAR(miss.most, depth - 0.4, dx);
  EXPECT_GT(miss.total, 0.0);
  EXPECT_LT(state_of_end(flow, 0).miss.since, 0.0);
}

/// The rows of the lattice deliver the discharge for any profile.
TEST(OpenEnd, ASteepProfileBringsTheDischarge) {
  const double depth = 0.4;
  const double speed = 0.5;
  CaseSpec spec = channel<2>(1.5, depth);
  spec.fluid[0].velocity = {speed, 0.0};
  spec.inlets[0].discharge = speed * depth;
  spec.inlets[0].profile = "s^(-0.5)";
  spec.outlets[0].level = depth;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 3.0) pass_and_step(flow);
  const double asked = speed * depth * flow.state.time;
  EXPECT_NEAR(state_of_end(flow, 0).asked, asked, 1e-9);
  EXPECT_NEAR(arrived_at(flow, 0).volume, asked, 0.02 * asked + dx * depth);
}

/// Water that enters with the profile of a channel has the turbulence of the water before the opening. It keeps it in
/// the buffer, which it crosses in a fifth of a second.
TEST(OpenEnd, ADevelopedProfileEntersWithItsTurbulence) {
  const double depth = 0.4;
  CaseSpec spec = channel<2>(1.5, depth);
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].roughness = 0.01;
  spec.fluid[0].velocity = {1.0, 0.0};
  spec.inlets[0].discharge = depth;
  spec.inlets[0].profile = "ln(1 + 1200*s)";
  spec.outlets[0].level = depth;
  Flow<2> flow = make_flow<2>(spec);
  start(flow);
  while (flow.state.time < 2.0) pass_and_step(flow);
  const Particles<2>& particles = flow.state.particles;
  const OpenEnd<2>& end = flow.part<OpenEnds<2>>().ends()[0];
  double entered = 0.0, before = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const double beyond = end.behind_border(particles.position[i]);
    if (!particles.is_fluid(i) || beyond < -end.stretch) continue;
    (beyond > 0.0 ? entered : before) += particles.volume[i] * particles.layer_viscosity[i];
  }
  EXPECT_GT(before, 0.0);
  EXPECT_NEAR(entered / before, 1.0, 0.3);
}

/// Open ends work in the published formulations too: still water between them does not accelerate, for any errors of
/// their pressure at the ends. It stays slower than a wave.
TEST(OpenEnd, ThePublishedFormulationsHaveThem) {
  for (const SchemeName name : {SchemeName::farzin2014, SchemeName::farmani2020}) {
    CaseSpec spec = channel<2>(1.0, 0.4);
    spec.scheme.name = name;
    spec.scheme.formulation = Formulation::published;
    apply_formulation(spec.scheme);
    spec.inlets[0].discharge = 0.0;
    spec.outlets[0].level = 0.4;
    Flow<2> flow = make_flow<2>(spec);
    start(flow);
    for (int n = 0; n < 10; ++n) pass_and_step(flow);
    EXPECT_LT(measure(flow).largest_speed, std::sqrt(g * 0.4));
  }
}

}  // namespace level_end_test
}  // namespace tailwater
