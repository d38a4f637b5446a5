// Findings of `check` on holes in walls, conditions beyond openings, profiles of inlets, the space into which inlets
// flow, leaks of their water, and the depth at wave makers.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "checks/check.h"
#include "checks/checks.h"
#include "geometry/cases.h"
#include "motion/channel_end.h"

namespace tailwater {
namespace {

using namespace testing_cases;

/// The messages of all errors, one per line.
std::string errors_of(const CaseSpec& spec) {
  const Boundary<2> boundary = make_boundary<2>(spec);
  std::string text;
  for (const Finding& finding : check_geometry<2>(spec, boundary, make_fluid_particles<2>(spec, boundary))) {
    if (finding.severity == Severity::error) text += finding.message() + "\n";
  }
  return text;
}

/// A tank 1 m wide with a slot in its floor.
CaseSpec tank_over_slot() {
  CaseSpec spec = empty_case(0.02);
  spec.walls = {polyline({{0.0, 0.8}, {0.0, 0.0}, {0.4, 0.0}}), polyline({{0.6, 0.0}, {1.0, 0.0}, {1.0, 0.8}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {1.0, 0.4})};
  spec.outlets = {outlet({0.4, 0.0}, {0.6, 0.0})};
  spec.outlets[0].direction = {0.0, -1.0};
  return spec;
}

/// A tank 1 m wide with a slot in its side.
CaseSpec tank_with_slot() {
  CaseSpec spec = tank_over_slot();
  spec.walls = {polyline({{0.0, 0.8}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.1}}), polyline({{1.0, 0.2}, {1.0, 0.8}})};
  spec.outlets = {outlet({1.0, 0.1}, {1.0, 0.2})};
  return spec;
}

TEST(EndChecks, AHoleNeedsSomethingBeyond) {
  for (CaseSpec spec : {tank_over_slot(), tank_with_slot()}) {
    const std::string refused = errors_of(spec);
    EXPECT_NE(refused.find("is a hole in a wall, and the case does not define the far side"), std::string::npos)
        << refused;
    EXPECT_NE(refused.find("give beyond = \"air\""), std::string::npos) << refused;
    spec.outlets[0].beyond = Beyond::air;
    EXPECT_EQ(errors_of(spec), "");
  }
  CaseSpec drowned = tank_with_slot();
  drowned.outlets[0].level = Varying{0.4};  // above the top of the slot
  EXPECT_EQ(errors_of(drowned), "");
  CaseSpec flush_inlet = tank_with_slot();
  flush_inlet.outlets.clear();
  flush_inlet.inlets = {inlet({1.0, 0.1}, {1.0, 0.2}, 0.01)};
  flush_inlet.inlets[0].direction = {-1.0, 0.0};
  EXPECT_EQ(errors_of(flush_inlet), "");
}

// An opening stays where it is drawn: a wall that leaves its rim would leave a gap.
TEST(EndChecks, AnOpeningInAMovingWallIsRefused) {
  CaseSpec spec = tank_with_slot();
  spec.outlets[0].beyond = Beyond::air;
  spec.walls[1].displacement = {"0.1*t", "0"};
  const std::string refused = errors_of(spec);
  EXPECT_NE(refused.find("has its rim at (1, 0.2) on wall 'wall2', which moves"), std::string::npos) << refused;
  EXPECT_NE(refused.find("draw a wall at rest around the opening"), std::string::npos) << refused;
  spec.walls[1].points.front() = {1.0, 0.3};
  spec.walls.push_back(polyline({{1.0, 0.2}, {1.0, 0.3}}));
  EXPECT_EQ(errors_of(spec).find("which moves"), std::string::npos) << errors_of(spec);
}

/// A shaft leads to this outlet, so the channel continues below it.
TEST(EndChecks, AShaftIsNoHole) {
  CaseSpec spec = tank_over_slot();
  spec.walls[0].points.push_back({0.4, -0.2});
  spec.walls[1].points.insert(spec.walls[1].points.begin(), {0.6, -0.2});
  spec.outlets[0].from = {0.4, -0.2};
  spec.outlets[0].to = {0.6, -0.2};
  EXPECT_EQ(errors_of(spec), "");
}

/// The program has an array of places across each opening: 1e15 m of them would fill the memory.
TEST(EndChecks, AnOpeningIsNotFarLargerThanTheCase) {
  CaseSpec spec = tank_with_slot();
  spec.outlets[0].beyond = Beyond::air;
  spec.walls.pop_back();
  spec.outlets[0].to = {1.0, 1e15};
  const std::string refused = errors_of(spec);
  EXPECT_NE(refused.find("more than 10 times the size of all walls and water"), std::string::npos) << refused;
}

TEST(EndChecks, TheSpaceBeyondIsFree) {
  CaseSpec spec = tank_with_slot();
  spec.outlets[0].level = Varying{0.3};
  spec.walls.push_back(polyline({{1.15, 0.0}, {1.15, 0.5}}));  // 10 spacings are 0.2 m
  const std::string refused = errors_of(spec);
  EXPECT_NE(refused.find("wall 'wall3' stands beyond outlet 'outlet1' at (1.15, "), std::string::npos) << refused;
  EXPECT_NE(refused.find("up to 0.2 m outside of it must be free"), std::string::npos) << refused;
  spec.walls.back() = polyline({{1.25, 0.0}, {1.25, 0.5}});
  EXPECT_EQ(errors_of(spec), "");
}

/// Where the walls lead straight to an opening, its duct has no lead: 4 spacings, 0.08 m, must be free.
TEST(EndChecks, TheSpaceBeyondIsShortWhereWallsLeadToTheOpening) {
  CaseSpec spec = tank_over_slot();
  spec.walls[0].points.push_back({0.4, -0.2});
  spec.walls[1].points.insert(spec.walls[1].points.begin(), {0.6, -0.2});
  spec.outlets[0].from = {0.4, -0.2};
  spec.outlets[0].to = {0.6, -0.2};
  spec.walls.push_back(polyline({{0.3, -0.3}, {0.7, -0.3}}));
  EXPECT_EQ(errors_of(spec), "");
  spec.walls.back() = polyline({{0.3, -0.27}, {0.7, -0.27}});
  EXPECT_NE(errors_of(spec).find("up to 0.08 m outside of it must be free"), std::string::npos) << errors_of(spec);
}

// The particles of a wall are behind it, so they would stand in the duct. The water there had three times its density.
TEST(EndChecks, AWallBesideADuctFacesIt) {
  CaseSpec spec = empty_case(0.02);
  spec.walls = {polyline({{0.0, 0.0}, {1.0, 0.0}}), polyline({{0.0, 0.2}, {-1.0, 0.2}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {0.2, 0.2})};
  spec.inlets = {inlet({0.0, 0.0}, {0.0, 0.2}, Varying(0.1))};
  EXPECT_EQ(errors_of(spec).find("stands beyond"), std::string::npos) << errors_of(spec);
  spec.walls[1] = polyline({{-1.0, 0.2}, {0.0, 0.2}});
  EXPECT_NE(errors_of(spec).find("wall 'wall2' stands beyond inlet"), std::string::npos) << errors_of(spec);
}

TEST(EndChecks, DuctsDoNotMeet) {
  CaseSpec spec = empty_case(0.02);
  spec.walls = {polyline({{0.0, 0.8}, {0.0, 0.0}, {1.0, 0.0}}), polyline({{1.125, 0.0}, {2.0, 0.0}, {2.0, 0.8}})};
  spec.outlets = {outlet({1.0, 0.0}, {1.0, 0.5}), outlet({1.125, 0.0}, {1.125, 0.5})};  // ducts of 4 spacings
  spec.outlets[1].direction = {-1.0, 0.0};
  spec.outlets[0].level = spec.outlets[1].level = Varying{0.3};
  const std::string refused = errors_of(spec);
  EXPECT_NE(refused.find("outlet 'outlet1' and outlet 'outlet2' share the space at (1.05"), std::string::npos)
      << refused;
}

/// For an inlet that enters upwards, the message gives a time, as for any other inlet.
TEST(EndChecks, AnUprightInletMayStopWithinAWave) {
  CaseSpec spec = tank_over_slot();
  spec.outlets.clear();
  spec.inlets = {inlet({0.4, 0.0}, {0.6, 0.0}, Varying("t < 0.5 ? 0.01 : 0"))};
  spec.inlets[0].direction = {0.0, 1.0};
  spec.time.end = 1.0;
  const std::string refused = errors_of(spec);
  // Four times 4 dx/sqrt(g 0.2 m).
  EXPECT_NE(refused.find("let it change over 0.23 s or more"), std::string::npos) << refused;
}

/// The sides of an inlet across a periodic channel are open to the next period and lie on no wall.
TEST(EndChecks, AnInletMaySpanAPeriod) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.domain.periodic_y = {0.0, 1.2};
  spec.walls = {box_wall({0, 0, 0}, {1.6, 1.2, 1.0}, {"+z", "-y", "+y", "-x"})};
  spec.fluid = {box_fluid({0, 0, 0}, {1.0, 1.2, 0.4})};
  spec.inlets = {inlet({0, 0, 0}, {0, 1.2, 0.9}, 0.1)};
  const Boundary<3> boundary = make_boundary<3>(spec);
  const Findings findings = check_open_ends(spec, boundary, make_fluid_particles<3>(spec, boundary));
  EXPECT_TRUE(findings.empty()) << findings.front().message();
}

std::string refusal_of_profile(const Varying& profile) {
  CaseSpec spec = open_channel();
  spec.inlets = {inlet({0.0, 0.0}, {0.0, 0.8}, 0.1)};
  spec.inlets[0].profile = profile;
  try {
    make_channel_ends<2>(spec);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(EndChecks, AProfileWithoutAMeanIsRefused) {
  for (const char* profile : {"1/s", "s^(-1.5)"}) {
    EXPECT_NE(refusal_of_profile(profile).find("grows without bound towards s = 0, the bed"), std::string::npos)
        << profile;
  }
  EXPECT_NE(refusal_of_profile("1/(1 - s)").find("towards s = 1, the surface"), std::string::npos);
  for (const char* profile : {"s^(-0.5)", "s^(1/7)", "3*s", "min(10, 1/s)"}) {
    EXPECT_EQ(refusal_of_profile(profile), "accepted") << profile;
  }
  EXPECT_EQ(refusal_of_profile(2.0), "accepted");
  for (const Varying& profile : {Varying(0.0), Varying(-1.0), Varying("s - 0.5")}) {
    EXPECT_NE(refusal_of_profile(profile).find("profile has the mean"), std::string::npos);
  }
}

/// Rows that fill the depth deliver the whole discharge, for any number of rows and any steepness of the profile.
TEST(EndChecks, RowsBringTheWholeProfile) {
  CaseSpec spec = open_channel();
  spec.inlets = {inlet({0.0, 0.0}, {0.0, 0.8}, 0.1)};
  spec.inlets[0].profile = "s^(-0.5)";
  const EndFlow flow = make_channel_ends<2>(spec)[0].flow;
  for (const int rows : {1, 3, 8, 50}) {
    double sum = 0.0;
    for (int k = 0; k < rows; ++k) sum += flow.profile_of_row((k + 0.5) / rows, 1.0 / rows);
    EXPECT_NEAR(sum / rows, 1.0, 1e-12) << rows;
    // The fraction sqrt(s) of the discharge is below s. The table misses 0.6/sqrt(n) of it in its lowest n parts.
    if (rows <= 8) {
      EXPECT_NEAR(flow.largest_in_profile(rows) / std::sqrt(rows), 1.0, 0.02) << rows;
    }
  }
}

/// A duct of 1.0 x 0.2 m holds the inflow of 1 s, but not of 3 s, unless it has an outlet or a hole.
TEST(EndChecks, AnInletNeedsASpaceForItsWater) {
  CaseSpec spec = empty_case(0.02);
  spec.walls = {polyline({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.2}, {0.0, 0.2}})};
  spec.inlets = {inlet({0.0, 0.0}, {0.0, 0.2}, 0.1)};
  spec.time.end = 1.0;
  EXPECT_EQ(errors_of(spec), "");
  spec.time.end = 3.0;
  const std::string refused = errors_of(spec);
  EXPECT_NE(
      refused.find("inlet 'inlet1' adds 0.3 m^2 by t = 3 s to the space closed by wall 'wall1', which has no outlet"),
      std::string::npos)
      << refused;
  EXPECT_NE(refused.find("closed by wall 'wall1'"), std::string::npos) << refused;
  CaseSpec half_full = spec;
  half_full.time.end = 1.5;
  EXPECT_EQ(errors_of(half_full), "");
  half_full.fluid.resize(1);
  half_full.fluid[0].min = {0.0, 0.0};
  half_full.fluid[0].max = {1.0, 0.1};
  EXPECT_NE(errors_of(half_full).find("can hold at most 0.1"), std::string::npos) << errors_of(half_full);
  CaseSpec with_outlet = spec;
  with_outlet.walls = {polyline({{0.0, 0.0}, {1.0, 0.0}}), polyline({{1.0, 0.2}, {0.0, 0.2}})};
  with_outlet.outlets = {outlet({1.0, 0.0}, {1.0, 0.2})};
  EXPECT_EQ(errors_of(with_outlet), "");
  spec.walls[0].points.back() = {0.5, 0.2};
  spec.walls.push_back(polyline({{0.3, 0.2}, {0.0, 0.2}}));
  EXPECT_EQ(errors_of(spec), "");
}

/// Two pieces of a channel's bed with a gap between them, initially dry.
TEST(EndChecks, WaterThatComesInMustNotPourOut) {
  CaseSpec spec = empty_case(0.02);
  spec.walls = {polyline({{0.0, 0.1}, {0.5, 0.0}}), polyline({{0.6, 0.0}, {1.0, 0.0}})};
  spec.outlets = {outlet({1.0, 0.0}, {1.0, 0.5})};
  spec.inlets = {inlet({0.0, 0.1}, {0.0, 0.6}, 0.1)};
  EXPECT_NE(errors_of(spec).find("the water would pour out of the case at (0.51, 0.01)"), std::string::npos)
      << errors_of(spec);
  spec.walls[0].points.back() = {0.6, 0.0};
  EXPECT_EQ(errors_of(spec), "");
  CaseSpec from_beyond = spec;
  from_beyond.inlets.clear();
  from_beyond.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {0.4, 0.0}, {0.4, 0.6}}), polyline({{0.6, 0.0}, {1.0, 0.0}})};
  from_beyond.walls[0].fluid_side = FluidSide::left;
  from_beyond.fluid = {box_fluid({0.0, 0.0}, {0.4, 0.2})};
  EXPECT_EQ(errors_of(from_beyond), "");
  from_beyond.outlets[0].level = Varying{0.2};
  EXPECT_NE(errors_of(from_beyond).find("the water would pour out of the case at (0.59, 0.01), near wall 'wall2'"),
            std::string::npos)
      << errors_of(from_beyond);
}

TEST(EndChecks, ADryBasinMayFillFromALevelBeyond) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {1.0, 0.0}})};
  spec.outlets = {outlet({1.0, 0.0}, {1.0, 0.5})};
  EXPECT_NE(errors_of(spec).find("there is no fluid"), std::string::npos) << errors_of(spec);
  spec.outlets[0].level = Varying{0.3};
  EXPECT_EQ(errors_of(spec), "");
}

TEST(EndChecks, AWaveMakerWantsTheDepthOfItsWater) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{-1.0, 1.0}, {-1.0, 0.0}, {8.0, 0.0}, {8.0, 1.0}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {8.0, 0.5})};
  WaveMakerTable maker;
  maker.name = "piston";
  maker.from = {0.0, 0.0};
  maker.to = {0.0, 1.0};
  maker.height = 0.02;
  maker.period = 1.5;
  spec.wave_makers = {maker};
  for (const double depth : {0.1, 0.7}) {
    spec.wave_makers[0].depth = depth;
    const std::string refused = errors_of(spec);
    EXPECT_NE(refused.find("wave_maker 'piston': depth = "), std::string::npos) << refused;
    EXPECT_NE(refused.find("is 0.5 m deep at the start"), std::string::npos) << refused;
  }
  for (const double depth : {0.48, 0.5, 0.52}) {
    spec.wave_makers[0].depth = depth;
    EXPECT_EQ(errors_of(spec).find("wave_maker 'piston': depth = "), std::string::npos) << errors_of(spec);
  }
}

}  // namespace
}  // namespace tailwater
