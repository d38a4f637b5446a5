// Open ends: their warnings, their restored states, and the inflow from a head.
#include "open_ends/open_ends.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "case/reader.h"
#include "io/messages.h"
#include "open_ends/fibres.h"
#include "published/make_flow.h"

namespace tailwater {
namespace {

/// A tank with one outlet, at which a level is prescribed.
Flow<2> flow_with_outlet() {
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 1\n[[wall]]\npoints = [[0, 1], [0, 0], [2, 0]]\n[[fluid]]\nmin = [0, 0]\n"
      "max = [2, 0.5]\n[[outlet]]\nname = \"end\"\nfrom = [2, 0]\nto = [2, 1]\nlevel = 0.5\n",
      "case.toml");
  return make_flow<2>(spec);
}

/// The last warning at the end of a run whose outlet missed its level.
std::string warning_of(const LevelError& miss) {
  Flow<2> flow = flow_with_outlet();
  auto& ends = flow.part<OpenEnds<2>>();
  Json saved = ends.save();
  saved["states"][0]["miss"].update(
      {{"mean", miss.mean}, {"lasts", miss.lasts}, {"since", miss.since}, {"total", miss.total}, {"most", miss.most}});
  EXPECT_TRUE(ends.restore(saved));
  const std::size_t before = warnings().size();
  ends.warn_at_end(flow);
  return warnings().size() > before ? warnings().back() : "";
}

TEST(OpenEndsWarning, ReportsAtTheEndWhetherALevelIsHeldAgain) {
  EXPECT_EQ(warning_of({}), "");
  EXPECT_EQ(warning_of({.mean = -0.3, .lasts = 2.0, .since = 1.0, .total = 2.0, .most = -0.4}),
            "at t = 0 s the level at outlet 'end' is still 0.3 m too low; it was off for 2 s, by up to 0.4 m "
            "[level-off-at-end]");
  EXPECT_EQ(warning_of({.mean = 0.05, .lasts = 0.0, .since = 1.0, .total = 2.0, .most = 0.4}),
            "at t = 0 s the level at outlet 'end' is within a spacing again; it was off for 2 s, by up to 0.4 m "
            "[level-off-at-end]");
}

/// The warnings of a run in which an inlet has passed a net volume `passed` [m^3], compared with the prescribed volume.
std::string warning_of_discharge(double asked, double passed, bool circulates = false) {
  const std::string tank =
      "particles.spacing = 0.1\ntime.end = 1\n[[wall]]\npoints = [[0, 0], [2, 0]]\n[[fluid]]\nmin = [0, 0]\n"
      "max = [2, 0.5]\n[[outlet]]\nname = \"out\"\nfrom = [2, 0]\nto = [2, 1]\n[[inlet]]\nname = \"in\"\n"
      "from = [0, 0]\nto = [0, 1]\ndischarge = 0.1\n";
  const CaseSpec spec = read_case_text(tank + (circulates ? "water_from = \"out\"\n" : ""), "case.toml");
  Flow<2> flow = make_flow<2>(spec);
  auto& ends = flow.part<OpenEnds<2>>();
  Json saved = ends.save();
  saved["states"][0].update({{"asked", asked}, {"asked_total", std::abs(asked)}, {"depth", 0.5}});
  saved["states"][0][passed > 0.0 ? "arrived" : "departed"]["volume"] = std::abs(passed);
  EXPECT_TRUE(ends.restore(saved));
  const std::size_t before = warnings().size();
  ends.warn(flow);
  return warnings().size() > before ? warnings().back() : "";
}

TEST(OpenEndsWarning, ReportsADischargeThatIsNotDelivered) {
  EXPECT_EQ(warning_of_discharge(1.0, 0.9), "") << "two columns always wait for room";
  EXPECT_EQ(warning_of_discharge(-1.0, -0.9), "");
  EXPECT_NE(warning_of_discharge(1.0, 0.8).find("inlet 'in' brings less water than prescribed"), std::string::npos);
  EXPECT_NE(warning_of_discharge(-1.0, -0.8).find("inlet 'in' draws less water than prescribed"), std::string::npos);
  EXPECT_NE(warning_of_discharge(1.0, 1.2).find("inlet 'in' passes more water than prescribed"), std::string::npos);
  EXPECT_NE(warning_of_discharge(-1.0, -1.2).find("inlet 'in' passes more water than prescribed"), std::string::npos);
  EXPECT_NE(warning_of_discharge(1.0, 0.8, true).find("remedy: give a larger reserve"), std::string::npos);
}

/// An opening with the section of a valley: columns 0.05 m wide with their bottoms on two slopes of 1.
OpenEnd<3> valley() {
  const CaseSpec spec = read_case_text(
      "case.dimension = 3\nparticles.spacing = 0.05\ntime.end = 1\n[[wall]]\nshape = \"box\"\nmin = [0, 0, 0]\n"
      "max = [1, 1, 1]\nopen = [\"-x\", \"+z\"]\n[[inlet]]\nname = \"in\"\nfrom = [0, 0, 0]\nto = [0, 1, 0.5]\n"
      "discharge = 0.05\n",
      "case.toml");
  ChannelEnd<3> end = make_channel_ends<3>(spec)[0];
  for (SectionColumn& column : end.columns) column.bottom = std::abs(column.aside - 0.5);
  return OpenEnd<3>(end, Vec<3>(0.0, 0.0, -9.81), 0.05, 0.15);
}

TEST(SectionOfAnOpening, DepthAndAreaOfAValley) {
  const OpenEnd<3> end = valley();
  for (const double depth : {0.1, 0.25, 0.4}) {
    EXPECT_NEAR(end.area_below(depth), depth * depth, 0.05 * 0.05 / 4.0 + 1e-12) << "a triangle, in steps";
    EXPECT_NEAR(end.depth_of_area(end.area_below(depth)), depth, 1e-9);
  }
  const double critical = end.critical_depth(0.0);
  const auto excess = [&](double depth) {
    return 0.05 * 0.05 * end.breadth_at(depth) - 9.81 * std::pow(end.area_below(depth), 3);
  };
  EXPECT_LE(excess(critical + 1e-9), 0.0);
  EXPECT_GT(excess(critical - 1e-3), 0.0);
}

/// While the level rises, the discharge at the border of the buffer is the prescribed one. At the opening it is larger
/// by the rate at which the volume of the buffer grows.
TEST(SectionOfAnOpening, ARisingLevelIsFedInAdditionToTheDischarge) {
  const OpenEnd<3> end = valley();
  OpenEndState state;
  state.depth = 0.5;
  state.depth_rate = 0.02;
  state.entry_speed = 0.3;
  const Vec<3> at_border = end.opening.corner - end.stretch * end.opening.normal + Vec<3>(0.0, 0.5, 0.1);
  const Vec<3> at_opening = end.opening.corner + Vec<3>(0.0, 0.5, 0.1);
  const double bottom = end.columns[end.column_at(at_opening)].bottom;
  EXPECT_NEAR(-end.opening.normal.dot(end.velocity_at(state, at_border)), 0.3, 1e-12);
  EXPECT_NEAR(-end.opening.normal.dot(end.velocity_at(state, at_opening)), 0.3 + end.stretch * 0.02 / (0.5 - bottom),
              1e-12);
}

/// Fibres of equal speed move the buffer zone as one, for any column and height. Fibres that become deeper do so from
/// the bottom of their column.
TEST(SectionOfAnOpening, FibresOfOneSpeedMoveTheBufferAsOne) {
  OpenEnd<3> end = valley();
  end.flow.discharge.reset();
  OpenEndState state;
  state.fibre_speeds.assign(end.first_fibre.back(), 0.3);
  state.stretching = 0.1;
  state.depth = 0.5;
  const double behind_border = 0.5 * end.stretch;
  for (const double y : {0.02, 0.31, 0.5, 0.98}) {
    const Vec<3> x(end.opening.corner[0] + 0.5 * end.stretch, y, 0.49);
    const Vec<3> u = end.velocity_at(state, x);
    EXPECT_NEAR(end.opening.normal.dot(u), 0.3 - 0.1 * behind_border, 1e-12);
    EXPECT_NEAR(u[2], 0.1 * (0.49 - end.columns[end.column_at(x)].bottom), 1e-12);
    EXPECT_EQ(u[1], 0.0);
  }
}

/// Water in the buffer that is more than two spacings above the surface falls, also where all water becomes deeper.
TEST(SectionOfAnOpening, WaterHighAboveTheSurfaceFalls) {
  OpenEnd<3> end = valley();
  end.flow.discharge.reset();
  OpenEndState state;
  state.fibre_speeds.assign(end.first_fibre.back(), 0.0);
  state.stretching = 0.4;
  state.depth = 0.3;
  state.surface = 0.32;
  const auto rise = [&](double z) { return end.velocity_at(state, {end.opening.corner[0], 0.4, z})[2]; };
  EXPECT_GT(rise(0.42), 0.0) << "spray";
  EXPECT_LT(rise(0.48), 0.0);
  state.is_full = true;  // a conduit has no surface
  EXPECT_GT(rise(0.48), 0.0);
}

/// Rolls before the end lift the water of the buffer, and spray high above the surface falls. Where both meet, water
/// would pile up in a field with a divergence: nothing else moves it on.
TEST(SectionOfAnOpening, TheFlowOfTheBufferHasNoDivergence) {
  OpenEnd<3> end = valley();
  end.flow.discharge.reset();
  OpenEndState state;
  state.fibre_speeds.assign(end.first_fibre.back(), -0.1);
  state.stretching = 3.0;
  state.depth = 0.2;
  state.surface = 0.25;
  const double part = 1e-6;
  for (const double z : {0.2, 0.34, 0.36, 0.38, 0.39, 0.41, 0.45}) {  // the surface of spray is at 0.35, dx = 0.05
    for (const double x : {0.25, 0.5, 0.75}) {
      const Vec<3> at = end.opening.corner + Vec<3>(0.0, 0.5, z) - x * end.stretch * end.opening.normal;
      double divergence = 0.0;
      for (int k = 0; k < 3; ++k) {
        const Vec<3> step = part * Vec<3>::Unit(k);
        divergence += (end.velocity_at(state, at + step) - end.velocity_at(state, at - step))[k] / (2.0 * part);
      }
      EXPECT_NEAR(divergence, 0.0, 1e-6) << z << " " << x;
    }
  }
}

/// A jet that falls through a floor at an angle has no surface that rises from one side of the opening to the other.
TEST(SectionOfAnOpening, AnOutletInAFloorHasNoDepth) {
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 1\n[[wall]]\npoints = [[0, 2], [0, 1]]\n[[wall]]\npoints = [[1, 1], [1, "
      "2]]\n[[fluid]]\nmin = [0, 1]\nmax = [1, 1.5]\n[[outlet]]\nfrom = [0, 1]\nto = [1, 1]\ndirection = [0, -1]\n",
      "case.toml");
  Flow<2> flow = make_flow<2>(spec);
  const OpenEnd<2>& end = flow.part<OpenEnds<2>>().ends()[0];
  flow.role.assign(flow.state.particles.owned, Role::water);
  for (Vec<2>& velocity : flow.state.particles.velocity) velocity = {1.0, -2.0};
  OpenEndState state;
  find_fibres(end, flow, {}, state);
  const Vec<2> at = end.opening.corner + Vec<2>(0.5, 0.1);
  EXPECT_LT((end.velocity_at(state, at) - Vec<2>(0.0, -2.0)).norm(), 1e-12);
}

/// Water that rises before the end becomes deeper in the buffer, too, unless it fills the section: a jet may rise to
/// the lid of a full conduit, and piles up there if the buffer rises with it.
TEST(SectionOfAnOpening, DoesNotBecomeDeeperIfItIsFull) {
  Flow<2> flow = flow_with_outlet();
  const OpenEnd<2>& end = flow.part<OpenEnds<2>>().ends()[0];
  flow.role.assign(flow.state.particles.owned, Role::water);
  for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
    flow.state.particles.velocity[i] = {0.0, 3.0 * flow.state.particles.position[i][1]};
  }
  OpenEndState state;
  state.depth = 0.5;
  find_fibres(end, flow, {}, state);
  EXPECT_NEAR(state.stretching, 3.0, 1e-12);
  state.is_full = true;
  find_fibres(end, flow, {}, state);
  EXPECT_EQ(state.stretching, 0.0);
  state.is_full = false;
  state.depth = end.height;
  find_fibres(end, flow, {}, state);
  EXPECT_EQ(state.stretching, 0.0);
}

/// Bernoulli's law from the water at rest, and the characteristic that leaves the case.
TEST(InflowOfHead, HasTheEnergyOfTheHeadAndTheCharacteristicFromInside) {
  const double g = 9.81;
  const double head = 0.4;
  const double still = std::sqrt(g * head);
  for (const double invariant : {-1.9 * still, -1.5 * still, -1.0 * still}) {
    const Inflow inflow = inflow_of_head(g, head, invariant);
    EXPECT_NEAR(inflow.depth + inflow.speed * inflow.speed / (2.0 * g), head, 1e-12);
    EXPECT_NEAR(inflow.speed - 2.0 * std::sqrt(g * inflow.depth), invariant, 1e-12);
    EXPECT_NEAR(inflow.froude, inflow.speed / std::sqrt(g * inflow.depth), 1e-12);
    EXPECT_LE(inflow.froude, 1.0);
  }
}

TEST(InflowOfHead, IsCriticalIntoAirAndHydrostaticWhereWaterLeaves) {
  const double g = 9.81;
  const Inflow critical = inflow_of_head(g, 0.3, 0.0);
  EXPECT_NEAR(critical.depth, 0.2, 1e-12);
  EXPECT_NEAR(critical.froude, 1.0, 1e-12);
  const Inflow leaving = inflow_of_head(g, 0.3, -3.0 * std::sqrt(g * 0.3));
  EXPECT_NEAR(leaving.depth, 0.3, 1e-12);
  EXPECT_EQ(leaving.froude, 0.0);
  EXPECT_EQ(inflow_of_head(g, -0.1, 0.0).depth, 0.0);
}

TEST(OpenEnds, StatesOfAnotherNumberOfEndsAreRejected) {
  Flow<2> flow = flow_with_outlet();
  auto& ends = flow.part<OpenEnds<2>>();
  Json saved = ends.save();
  EXPECT_TRUE(ends.restore(saved));
  saved["states"].push_back(saved["states"][0]);
  EXPECT_FALSE(ends.restore(saved));
}

}  // namespace
}  // namespace tailwater
