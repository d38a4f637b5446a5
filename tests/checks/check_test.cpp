#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <string>
#include <utility>

#include "checks/check.h"
#include "checks/checks.h"
#include "geometry/cases.h"
#include "motion/wave_zone.h"
#include "support/circle.h"
#include "support/liquids.h"

namespace tailwater {
namespace {

using namespace testing_cases;

template <int Dim = 2>
std::vector<Finding> check(const CaseSpec& spec) {
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  return check_geometry<Dim>(spec, boundary, make_fluid_particles<Dim>(spec, boundary));
}

std::string listed(const std::vector<Finding>& findings) {
  std::string text = "findings:";
  for (const Finding& finding : findings) {
    text += (finding.severity == Severity::error ? "\n  error: " : "\n  warning: ") + finding.message();
  }
  return text;
}

/// The findings are exactly one, of this severity, and its message has all these parts.
void expect_only(const std::vector<Finding>& findings, Severity severity, const std::vector<std::string>& parts) {
  ASSERT_EQ(findings.size(), 1u) << listed(findings);
  EXPECT_EQ(findings[0].severity, severity) << listed(findings);
  for (const std::string& part : parts) {
    EXPECT_NE(findings[0].message().find(part), std::string::npos) << "'" << part << "' in " << listed(findings);
  }
}

/// One of the findings is of this severity and has all these parts.
void expect_among(const std::vector<Finding>& findings, Severity severity, const std::vector<std::string>& parts) {
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.severity == severity && std::all_of(parts.begin(), parts.end(), [&](const std::string& part) {
             return finding.message().find(part) != std::string::npos;
           });
  })) << listed(findings);
}

TEST(Check, AGoodCaseHasNoFindings) {
  CaseSpec spec = tank();
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.particles.jitter = 0.4;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.particles.jitter = 0.0;
  spec.scheme.formulation = Formulation::published;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, AGoodCaseIn3DHasNoFindings) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z"})};
  spec.fluid = {box_fluid({0, 0, 0}, {0.4, 0.5, 0.4})};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
}

// A dam break over a triangular sill with a pool behind it, the fluid drawn as polygons.
TEST(Check, ASlopedBedIsGood) {
  CaseSpec spec = empty_case(0.01);
  spec.walls = {polyline({{0, 0.4}, {0, 0}, {1, 0}, {1.4, 0.2}, {1.8, 0}, {3, 0}, {3, 0.4}})};
  spec.fluid = {box_fluid({0, 0}, {0.6, 0.3}), polygon_fluid({{1.8, 0}, {3, 0}, {3, 0.1}, {1.6, 0.1}})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

// A box that stands on the bed and touches it with its own bottom.
TEST(Check, AnObstacleOnTheBedIsGood) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 1}, {0, 0}, {3, 0}, {3, 1}}), box_wall({1.5, 0}, {1.8, 0.4}, {}, FluidSide::outside)};
  spec.fluid = {box_fluid({0, 0}, {1.5, 0.3})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, NoFluid) {
  CaseSpec spec = tank();
  spec.fluid.clear();
  expect_only(check(spec), Severity::error, {"no fluid", "[[fluid]]"});
}

TEST(Check, BlockSmallerThanTheSpacing) {
  CaseSpec spec = tank();
  spec.fluid = {box_fluid({0, 0}, {1, 0.04})};
  expect_among(check(spec), Severity::error, {"fluid 'fluid1'", "0.04 m long in y", "0.1 m"});
  spec.fluid = {polygon_fluid({{0.1, 0.1}, {0.13, 0.1}, {0.1, 0.13}})};
  expect_among(check(spec), Severity::error, {"fluid 'fluid1'", "holds no particle", "(0.1, 0.1)"});
}

TEST(Check, ExtentNeedNotBeAWholeNumberOfSpacings) {
  CaseSpec spec = tank();
  spec.fluid = {box_fluid({0, 0}, {0.6, 0.45})};
  EXPECT_TRUE(check(spec).empty());
}

TEST(Check, ABlockInsideAWallIsReportedAsSuch) {
  CaseSpec spec = tank();
  spec.walls.push_back(polygon({{0, 0}, {1, 0}, {1, 0.5}, {0, 0.5}}, FluidSide::outside));
  spec.fluid = {box_fluid({0, 0}, {0.5, 0.4})};
  expect_among(check(spec), Severity::error, {"fluid 'fluid1' at (0, 0) holds no particle", "in walls and bodies"});
  spec.fluid = {polygon_fluid({{0, 0}, {0.5, 0}, {0.5, 0.4}})};
  expect_among(check(spec), Severity::error, {"fluid 'fluid1' at (0, 0) holds no particle", "in walls and bodies"});
}

TEST(Check, OverlappingBlocks) {
  CaseSpec spec = tank();
  spec.fluid = {box_fluid({0, 0}, {0.5, 0.4}), box_fluid({0.4, 0}, {1, 0.4})};
  spec.fluid[0].name = "west";
  expect_only(check(spec), Severity::error, {"'west'", "'fluid2'", "(0.45, 0.05)", "4 particles"});
  spec.fluid[1].min[0] = 0.5;
  spec.particles.jitter = 0.4;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

// In each cell that their common edge cuts one of the two blocks has a particle.
TEST(Check, BlocksMayShareASlopingEdge) {
  CaseSpec spec = tank();
  for (const double high : {0.22, 0.25, 0.28, 0.3}) {
    spec.fluid = {polygon_fluid({{0, 0}, {1, 0}, {1, high}, {0, 0.2}}),
                  polygon_fluid({{0, 0.2}, {1, high}, {1, 0.4}, {0, 0.4}})};
    EXPECT_TRUE(check(spec).empty()) << high << ' ' << listed(check(spec));
    spec.fluid[1].points[0][1] = 0.05;
    spec.fluid[1].points[1][1] = high - 0.15;
    expect_among(check(spec), Severity::error, {"fluid 'fluid1' and fluid 'fluid2' overlap"});
  }
}

TEST(Check, FluidBehindAWall) {
  CaseSpec spec = tank();
  spec.walls[0].fluid_side = FluidSide::right;
  spec.walls[0].name = "tank";
  expect_among(check(spec), Severity::error, {"fluid 'fluid1' lies behind wall 'tank'", "40 particles", "fluid_side"});
}

TEST(Check, FluidOnBothSides) {
  CaseSpec spec = tank();
  spec.walls.push_back(polyline({{0.5, 0.6}, {0.5, 0.0}}));
  spec.walls[1].name = "gate";
  expect_among(check(spec), Severity::error, {"wall 'gate' has fluid on both sides", "fluid 'fluid1'"});
}

TEST(Check, FluidTooNearToAWall) {
  CaseSpec spec = tank();
  spec.fluid = {box_fluid({-0.03, 0}, {0.77, 0.4})};
  expect_only(check(spec), Severity::error, {"'fluid1' is too near to wall 'wall1'", "4 particles", "0.02 m", "0.1 m"});
}

TEST(Check, RoughnessLargerThanTheSpacing) {
  CaseSpec spec = tank();
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].manning = 0.03;  // gravel
  expect_only(check(spec), Severity::warning, {"wall 'wall1'", "k_s = 0.194 m", "manning = 0.03", "0.1 m", "draw"});
  spec.walls[0].manning = 0.02;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, RoughnessBeyondTheLawOfRoughWalls) {
  CaseSpec spec = tank();  // dx = 0.1 m, water 0.4 m deep
  spec.walls[0].slip = Slip::no_slip;
  spec.walls[0].manning = 0.1;
  expect_only(check(spec), Severity::error,
              {"k_s = 267 m", "15 spacings", "k_s/30 = 8.89 m", "manning = 0.0421 or less"});
  spec.walls[0].manning = 0.0;
  spec.walls[0].roughness = 0.5;
  expect_only(check(spec), Severity::error,
              {"k_s = 0.5 m", "than the water is deep, 0.4 m", "roughness of at most 0.396 m"});
  spec.walls[0].roughness = 0.3;
  expect_only(check(spec), Severity::warning, {"k_s = 0.3 m", "larger than the spacing"});
  spec.walls[0].roughness = 0.0;
  spec.physics.channel_width = 0.6;
  spec.physics.channel_roughness = 0.4;
  expect_only(check(spec), Severity::error, {"channel_roughness = 0.4 m", "half of the channel's width, 0.3 m"});
}

TEST(Check, GapBetweenFluidAndWall) {
  CaseSpec spec = tank();
  spec.fluid = {box_fluid({0.06, 0}, {0.56, 0.4})};
  expect_only(check(spec), Severity::warning, {"gap", "'fluid1'", "'wall1'", "1.10 spacings", "(0.11, "});
  spec.fluid = {box_fluid({0.3, 0}, {0.6, 0.4})};  // on purpose away from the wall
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, RoundBodiesHaveAGapOnlyWhereWaterIsAwayFromAllOfThem) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 2}, {0, 0}, {2, 0}, {2, 2}}),
                polygon(circle(48, 0.25, {1.013, 0.9}), FluidSide::outside)};
  spec.fluid = {box_fluid({0, 0}, {2, 1})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.walls[1] = polygon(circle(24, 0.2, {1.0, 1.0}), FluidSide::outside);
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.fluid = {box_fluid({0, 0}, {2, 0.75})};  // 0.05 m under the body
  expect_only(check(spec), Severity::warning, {"gap between fluid 'fluid1' and wall 'wall2'", "1.5"});
}

TEST(Check, WaveLowerThanTwoSpacings) {
  CaseSpec spec = tank();
  WaveMakerTable maker;
  maker.name = "piston";
  maker.from = {0, 0};
  maker.to = {0, 1};
  maker.depth = 0.4;
  maker.height = 0.19;
  maker.period = 2.0;
  spec.wave_makers = {maker};
  const Boundary<2> boundary = make_boundary<2>(spec);
  const auto fluid = make_fluid_particles<2>(spec, boundary);
  expect_only(check_wave_makers<2>(spec, fluid), Severity::warning,
              {"height = 0.19 m is 1.9 spacings", "2 spacings are not resolved", "at most 0.094 m"});
  spec.wave_makers[0].height = 0.2;
  EXPECT_TRUE(check_wave_makers<2>(spec, fluid).empty());
  spec.wave_makers[0].height = 0.038;
  expect_only(check_wave_makers<2>(spec, fluid), Severity::error,
              {"height = 0.038 m is 0.38 spacings", "lower than 0.5 spacings do not keep", "at most 0.0188 m"});
  spec.wave_makers[0].height = 0.2;
  spec.wave_makers[0].to = {0, 0.45};
  expect_only(check_wave_makers<2>(spec, fluid), Severity::warning, {"'piston' ends 0.05 m above", "0.1 m high"});
}

/// A floating box from `left` to `right` [m] between walls at 0 and 2 m.
CaseSpec box_between_walls(double left, double right) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 2}, {0, 0}, {2, 0}, {2, 2}}),
                box_wall({left, 0.7}, {right, 1.1}, {}, FluidSide::outside)};
  spec.walls[1].name = "hull";
  spec.fluid = {box_fluid({0, 0}, {2, 0.6})};
  BodyTable body;
  body.name = "b";
  body.walls = {"hull"};
  body.mass = 400.0 * (right - left);
  body.centre = {0.5 * (left + right), 0.9};
  body.inertia = {0.1 * body.mass};
  body.free = {"x", "y", "rotation"};
  body.velocity = {0.0, 0.0};
  spec.bodies = {body};
  spec.walls[1].drive = {Drive::By::body, 0};
  return spec;
}

TEST(Check, BodyThatLetsNoWaterPass) {
  const CaseSpec narrow = box_between_walls(0.02, 1.98);
  expect_only(
      check_body_gaps<2>(narrow, make_boundary<2>(narrow)), Severity::error,
      {"both sides of body 'b'", "together 0.04 m", "wall 'wall1'", "0.8 spacings", "leave 0.152 m", "0.0132 m"});
  CaseSpec touching = box_between_walls(0.0, 2.0);
  expect_only(check_body_gaps<2>(touching, make_boundary<2>(touching)), Severity::error,
              {"together 0 m", "leave 0.152 m"});
  touching.air.pockets = AirPockets::adiabatic;
  EXPECT_TRUE(check_body_gaps<2>(touching, make_boundary<2>(touching)).empty());
  for (const CaseSpec& good :
       {box_between_walls(0.02, 1.84), box_between_walls(0.08, 1.92), box_between_walls(0.02, 1.0)}) {
    EXPECT_TRUE(check_body_gaps<2>(good, make_boundary<2>(good)).empty());
  }
}

TEST(Check, BodyThatIsTooLight) {
  CaseSpec spec = box_between_walls(0.5, 1.0);
  spec.bodies[0].mass = 1.0;
  spec.bodies[0].inertia = {0.03};
  expect_only(
      check_bodies<2>(spec, make_boundary<2>(spec)), Severity::error,
      {"body 'b': mass = 1 kg", "a draught of 0.002 m", "0.05 spacings", "at least 1.26 kg", "at most 0.0396 m"});
  spec.bodies[0].mass = 1.3;
  EXPECT_TRUE(check_bodies<2>(spec, make_boundary<2>(spec)).empty());
}

TEST(Check, BodyThatTurnsTooEasily) {
  CaseSpec spec = box_between_walls(0.5, 1.0);
  spec.bodies[0].mass = 100.0;
  spec.bodies[0].inertia = {1e-4};
  expect_only(check_bodies<2>(spec, make_boundary<2>(spec)), Severity::error,
              {"body 'b': inertia", "radius of inertia of 0.001 m", "0.05 spacings", "at least 0.000631 kg m^2"});
  spec.bodies[0].inertia = {7e-4};
  EXPECT_TRUE(check_bodies<2>(spec, make_boundary<2>(spec)).empty());
  spec.bodies[0].inertia = {1e-4};
  spec.bodies[0].free = {"x", "y"};
  EXPECT_TRUE(check_bodies<2>(spec, make_boundary<2>(spec)).empty());
}

TEST(Check, WallThatCrossesItself) {
  CaseSpec spec = tank();
  spec.walls.push_back(polyline({{2, 0}, {3, 1}, {3, 0}, {2, 1}}));
  expect_among(check(spec), Severity::error, {"wall 'wall2' crosses itself at (2.5, 0.5)"});
  spec = tank();
  spec.fluid[0].shape = BlockShape::polygon;
  spec.fluid[0].points = {{0.2, 0.0}, {0.6, 0.4}, {0.6, 0.0}, {0.2, 0.4}};
  expect_among(check(spec), Severity::error, {"the outline of fluid 'fluid1' crosses itself at (0.4, 0.2)"});
}

TEST(Check, WallThinnerThanItsLayers) {
  CaseSpec spec = tank();
  spec.walls.push_back(box_wall({0.6, -0.1}, {0.8, 0.5}, {"-y"}, FluidSide::outside));
  spec.walls[1].name = "pier";
  spec.fluid = {box_fluid({0, 0}, {0.6, 0.4})};
  expect_among(check(spec), Severity::error, {"wall 'pier' is only 0.2 m thick", "3 layers", "0.3 m"});
}

/// A ramp of a radius of 1 m in `pieces` that rises from 0 to an angle, and ends at a lip above a vertical back.
CaseSpec curved_lip(double degrees, int pieces) {
  CaseSpec spec = empty_case(0.02);
  std::vector<Coordinates> points = {{-0.5, 0.0}};
  const double angle = degrees / 180.0 * std::numbers::pi;
  for (int k = 0; k <= pieces; ++k) {
    points.push_back({std::sin(angle * k / pieces), 1.0 - std::cos(angle * k / pieces)});
  }
  const double lip = points.back()[0];
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{{lip, -1.0}, {3.0, -1.0}, {3.0, 1.0}}) {
    points.push_back({x, y});
  }
  points.insert(points.begin(), {-0.5, 1.0});
  spec.walls = {polyline(points)};
  spec.fluid = {box_fluid({-0.5, 0.0}, {0.0, 0.1}), box_fluid({lip, -1.0}, {3.0, -0.9})};
  return spec;
}

TEST(Check, ACurvedLipIsAWedgeAsAStraightOneIs) {
  for (const double degrees : {20.0, 25.0, 40.0, 60.0, 75.0}) {
    for (const int pieces : {1, 3, 10, 50, 200}) {
      const CaseSpec spec = curved_lip(degrees, pieces);
      EXPECT_EQ(listed(check(spec)).find("thick"), std::string::npos)
          << degrees << " " << pieces << listed(check(spec));
    }
  }
}

// A plate of two spacings with a sharp top stays too thin below it.
TEST(Check, AThinWallWithASharpTopIsReported) {
  CaseSpec spec = tank();
  for (const double tip : {0.05, 0.1, 0.2, 0.4}) {
    spec.walls.resize(1);
    spec.walls.push_back(polyline({{0.6, 0.0}, {0.6, 0.6 - tip}, {0.8, 0.6}, {0.8, 0.0}}, FluidSide::left));
    spec.walls[1].name = "pier";
    spec.fluid = {box_fluid({0, 0}, {0.6, 0.1}), box_fluid({0.8, 0}, {1.0, 0.1})};
    expect_among(check(spec), Severity::error, {"wall 'pier' is only 0.2 m thick"});
  }
}

TEST(Check, TwoWallsBackToBackHaveNoThickness) {
  CaseSpec spec = tank();
  spec.walls.push_back(polyline({{0.5, 0.6}, {0.5, 0.0}}));
  spec.walls.push_back(polyline({{0.5, 0.6}, {0.5, 0.0}}, FluidSide::right));
  expect_among(check(spec), Severity::error, {"wall 'wall2' is only 0 m thick", "'wall3' on its other side"});
}

// Behind the dry wall nothing held the water: the layers of the wet one end at it.
TEST(Check, AWallWithADryWallCloseBehindItIsTooThin) {
  CaseSpec spec = tank();
  spec.particles.spacing = 0.05;
  spec.fluid = {box_fluid({0.0, 0.0}, {0.5, 0.4})};
  spec.walls.push_back(polyline({{0.5, 0.0}, {0.5, 0.6}}));
  spec.walls.push_back(polyline({{0.55, 0.6}, {0.55, 0.0}}));
  expect_only(check(spec), Severity::error, {"wall 'wall2' is only 0.05 m thick", "'wall3' on its other side"});
  spec.walls.back().points = {{0.7, 0.6}, {0.7, 0.0}};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, WaterThatPoursOut) {
  CaseSpec spec = tank();
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {0.7, 0.0}})};
  spec.walls[0].name = "tank";
  spec.fluid = {box_fluid({0, 0}, {0.4, 0.4})};
  expect_only(check(spec), Severity::error, {"pour out", "near wall 'tank'"});
  spec.physics.gravity = {0.0, 0.0};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, WaterThatPoursOverALowWallOrThroughAHole) {
  CaseSpec spec = tank();
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.2}})};
  spec.fluid = {box_fluid({0, 0}, {0.5, 0.4})};
  expect_only(check(spec), Severity::error, {"pour out"});
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {0.6, 0.0}}), polyline({{0.8, 0.0}, {1.0, 0.0}, {1.0, 0.6}})};
  expect_only(check(spec), Severity::error, {"pour out"});
  spec.walls[1].points[0] = {0.6, 0.0};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

/// Water with a level surface 0.2 m deep on average in a tank 2 m long, turned by an angle. Its walls end so much above
/// the surface, along gravity.
CaseSpec turned_tank(double degrees, double left, double right) {
  CaseSpec spec = empty_case(0.02);
  const double slope = std::tan(degrees / 180.0 * std::numbers::pi);
  spec.physics.gravity = {9.81 * slope / std::hypot(1.0, slope), -9.81 / std::hypot(1.0, slope)};
  const double deep = 0.2 + 2.0 * slope;
  spec.walls = {polyline({{0.0, 0.2 + left}, {0.0, 0.0}, {2.0, 0.0}, {2.0, deep + right}})};
  spec.fluid = {polygon_fluid({{0.0, 0.0}, {2.0, 0.0}, {2.0, deep}, {0.0, 0.2}})};
  return spec;
}

TEST(Check, WaterPoursOutOverWallsBelowItsLevelAtAnyAngleOfGravity) {
  for (const double degrees : {0.01, 1.0, 5.0, 11.0, 20.0, 29.0, 30.0, 35.0, 45.0, 50.0, 70.0}) {
    const double angle = degrees / 180.0 * std::numbers::pi;
    const double margin = 0.04 / std::cos(angle);  // two cells, across the surface
    const CaseSpec good = turned_tank(degrees, margin, margin);
    EXPECT_TRUE(check(good).empty()) << degrees << listed(check(good));
    expect_among(check(turned_tank(degrees, -margin, 2.0 * margin)), Severity::error, {"pour out"});
    expect_among(check(turned_tank(degrees, 2.0 * margin, -margin)), Severity::error, {"pour out"});
  }
}

TEST(Check, AFilmRunsDownASlopeInAPeriod) {
  CaseSpec spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 1.2};
  spec.walls = {polyline({{0.0, 0.0}, {1.2, 0.0}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {1.2, 1.0})};
  for (const double degrees : {0.0, 5.7, 35.0, 60.0, 90.0}) {
    const double angle = degrees / 180.0 * std::numbers::pi;
    spec.physics.gravity = {9.81 * std::sin(angle), degrees == 90.0 ? 0.0 : -9.81 * std::cos(angle)};
    EXPECT_TRUE(check(spec).empty()) << degrees << listed(check(spec));
  }
}

TEST(Check, WaterThatPoursOverAnOutletThatIsTooLow) {
  CaseSpec spec = tank();
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.3}, {0.5, 0.3}, {0.5, 0.0}, {2.0, 0.0}})};
  spec.fluid = {box_fluid({0, 0.3}, {0.5, 0.5})};
  spec.outlets = {outlet({2.0, 0.0}, {2.0, 0.4})};
  expect_among(check(spec), Severity::error, {"pour out", "near outlet"});
  spec.outlets[0].to = {2.0, 0.6};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

// Slopes of 45 degrees pass exactly through the centres of a grid that is in step with the lattice.
TEST(Check, SlantedWallsAreTight) {
  for (const double shift : {0.0, 0.025, 0.05, 0.075}) {
    CaseSpec spec = empty_case(0.1);
    spec.walls = {polyline({{0, 2}, {0, 0.5}, {0.5 + shift, shift}, {1 + shift, shift}, {2, 1}, {2, 2}})};
    spec.fluid = {box_fluid({0.6, 0.6}, {1, 1})};
    EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  }
}

/// Two basins beside a wall 0.6 m high, and over it a hood that reaches down into both, filled.
TEST(Check, ASiphonThatWouldRunEmpty) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 1}, {0, 0}, {0.6, 0}, {0.6, 0.6}, {0.9, 0.6}, {0.9, 0}, {1.5, 0}, {1.5, 1}})};
  WallTable hood;
  hood.name = "hood";
  hood.shape = WallShape::plate;
  hood.points = {{0.3, 0.3}, {0.3, 0.9}, {1.2, 0.9}, {1.2, 0.3}};
  spec.walls.push_back(hood);
  const auto basins = {box_fluid({0, 0}, {0.3, 0.5}), box_fluid({1.2, 0}, {1.5, 0.4})};
  spec.fluid = basins;
  for (const auto& inside :
       {box_fluid({0.3, 0}, {0.6, 0.9}), box_fluid({0.6, 0.6}, {0.9, 0.9}), box_fluid({0.9, 0}, {1.2, 0.9})}) {
    spec.fluid.push_back(inside);
  }
  expect_only(check(spec), Severity::warning,
              {"below wall 'hood'", "0.4 m above the free surface that it is connected to", "siphon"});
  spec.physics.tension = 2e5;  // more than the atmosphere carries
  expect_only(check(spec), Severity::warning, {"physics.tension = 2e+05 Pa", "boils", "at most 1e+05 Pa"});
  spec.physics.tension = 0.0;
  spec.air.pockets = AirPockets::adiabatic;  // half of it comes down in 2 s
  expect_only(check(spec), Severity::warning,
              {"below wall 'hood'", "0.4 m above the free surface that it is connected to", "siphon"});
  spec.fluid = basins;
  spec.fluid.push_back(box_fluid({0.3, 0}, {0.6, 0.5}));
  spec.fluid.push_back(box_fluid({0.9, 0}, {1.2, 0.4}));
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, WaterThatPoursOutIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z", "+x"})};
  spec.fluid = {box_fluid({0, 0, 0}, {0.4, 0.5, 0.4})};
  expect_only(check<3>(spec), Severity::error, {"pour out"});
}

// 0.16 m2 of mud with a yield stress of 0.1 m come to rest 0.42 m from their middle (Liu & Mei), on a table that ends
// at `half`.
CaseSpec mud_on_table(double half, double drop) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{-half, -drop}, {0.0, 0.0}, {half, -drop}})};
  spec.walls[0].slip = Slip::no_slip;
  spec.fluid = {box_fluid({-0.2, 0}, {0.2, 0.4})};
  LiquidTable mud = bingham(1000.0, 981.0);
  mud.density = 1000.0;
  fill_with(spec, mud);
  return spec;
}

TEST(Check, AYieldingLiquidStopsOnAnOpenTable) {
  EXPECT_TRUE(check(mud_on_table(0.8, 0.0)).empty()) << listed(check(mud_on_table(0.8, 0.0)));
  expect_only(check(mud_on_table(0.4, 0.0)), Severity::warning, {"may pour out", "up to 0.624 m from"});
  CaseSpec water = mud_on_table(0.8, 0.0);
  water.liquids[0].yield_stress = 0.0;
  expect_only(check(water), Severity::error, {"would pour out"});
  CaseSpec slippery = mud_on_table(0.8, 0.0);
  slippery.walls[0].slip = Slip::free;
  expect_only(check(slippery), Severity::error, {"would pour out"});
}

/// Only the ends of a long dyke move: 0.8 m of front, a third of it beyond the start, and half as much for its inertia.
TEST(Check, TheEndsOfALongDykeOfYieldingLiquidMayPourOut) {
  CaseSpec spec = mud_on_table(5.36, 0.0);
  spec.fluid[0].min[0] = -5.0;
  spec.fluid[0].max[0] = 5.0;
  expect_only(check(spec), Severity::warning, {"may pour out", "up to 5.4 m from"});
  spec.walls = mud_on_table(5.5, 0.0).walls;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, AYieldingLiquidOnASlopeMayPourOut) {
  expect_among(check(mud_on_table(0.8, 0.3)), Severity::warning, {"would pour out", "unless it stops before"});
}

TEST(Check, AYieldingLiquidStopsOnAnOpenTableIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({-0.2, -0.2, 0}, {0.2, 0.2, 0.4})};
  spec.walls = {box_wall({-0.8, -0.8, 0}, {0.8, 0.8, 0.6}, {"+x", "-x", "+y", "-y", "+z"})};
  spec.walls[0].slip = Slip::no_slip;
  fill_with(spec, mud_on_table(0.8, 0.0).liquids[0]);
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
  spec.walls = {box_wall({-0.8, -0.2, 0}, {0.8, 0.2, 0.6}, {"+x", "-x", "+z"})};
  spec.walls[0].slip = Slip::no_slip;
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
  spec.liquids[0].yield_stress = 98.1;
  expect_only(check<3>(spec), Severity::warning, {"may pour out", "up to 1.34 m from"});
}

TEST(Check, WaterGoesRoundAPeriodicDomain) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 0}, {2, 0}})};
  spec.fluid = {box_fluid({0, 0}, {2, 0.4})};
  expect_only(check(spec), Severity::error, {"pour out"});
  spec.domain.periodic_x = {0.0, 2.0};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, BlocksThatOverlapThroughThePeriodAreRefused) {
  CaseSpec spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 2.0};
  spec.walls = {polyline({{0, 0}, {2, 0}})};
  spec.fluid = {box_fluid({0, 0}, {2.3, 0.4})};
  expect_among(check(spec), Severity::error,
               {"fluid 'fluid1' overlaps itself through the period", "12 of its particles", "at most one period"});
  spec.fluid = {box_fluid({-4, 0}, {40, 0.4})};
  expect_among(check(spec), Severity::error, {"fluid 'fluid1' overlaps itself through the period"});
  spec.fluid = {box_fluid({0, 0}, {1.2, 0.4}), box_fluid({1.2, 0}, {2.2, 0.4})};
  expect_among(check(spec), Severity::error,
               {"fluid 'fluid1' and fluid 'fluid2' overlap through the period", "8 particles"});
  spec.fluid = {box_fluid({0.5, 0}, {1.2, 0.4}), box_fluid({1.2, 0}, {2.5, 0.4})};  // one period of water
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.particles.jitter = 0.4;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, AFillRoundAPeriodicDomain) {
  CaseSpec spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 1.2};
  spec.walls = {polyline({{0, 0}, {1.2, 0}})};
  FluidTable water;
  water.shape = BlockShape::fill;
  water.seed = {0.6, 0.3};
  water.level = 0.6;
  spec.fluid = {water};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, PeriodicDirectionTooNarrow) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 0}, {1, 0}})};
  spec.fluid = {box_fluid({0, 0}, {1, 0.4})};
  spec.domain.periodic_x = {0.0, 1.0};
  expect_only(check(spec), Severity::error, {"periodic_x from 0 to 1", "1.2 m wide", "0.0833333 m"});
}

TEST(Check, AForceProbeOnAPlateNearAnotherWall) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 0.9}, {0, 0}, {1.2, 0}, {1.2, 0.9}}), polyline({{0.4, 0.1}, {0.8, 0.1}})};
  spec.walls[0].name = "tank";
  spec.walls[1].name = "shelf";
  spec.walls[1].shape = WallShape::plate;
  spec.fluid = {box_fluid({0, 0}, {1.2, 0.6})};
  ProbeTable probe;
  probe.name = "lift";
  probe.type = ProbeType::force;
  probe.walls = {"shelf"};
  spec.probes = {probe};
  expect_among(check(spec), Severity::warning, {"probe 'lift'", "cannot separate", "0.02 m"});
  spec.probes[0].walls = {"shelf", "tank"};
  expect_only(check(spec), Severity::warning, {"2.0 spacings wide"});
  spec.probes[0].walls = {"shelf"};
  spec.walls[1].points = {{0.4, 0.3}, {0.8, 0.3}};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

// A block of the bed that rises by two spacings, as in an earthquake.
TEST(Check, AMovingWallThatComesOffAnother) {
  CaseSpec spec = empty_case(0.1);
  spec.time.end = 2.0;
  spec.walls = {polyline({{0, 1}, {0, -0.4}, {1, -0.4}, {1, 0}, {3, 0}, {3, 1}}), polyline({{0, 0}, {1, 0}})};
  spec.walls[1].name = "block";
  spec.walls[1].displacement = {0.0, "0.2*(1 - exp(-4*t))"};
  spec.fluid = {box_fluid({0, 0}, {3, 0.5})};
  expect_only(check(spec), Severity::warning,
              {"wall 'block' comes off another wall", "its end (1, 0)", "longer there"});
  spec.walls[1].points = {{0, 0}, {1, 0}, {1, -0.35}};
  spec.walls[0].points[2] = {1.05, -0.4};
  spec.walls[0].points[3] = {1.05, 0};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  // A paddle stays on its bed.
  spec.walls = {polyline({{-1, 0}, {3, 0}, {3, 1}}), polyline({{0, 1}, {0, 0}})};
  spec.walls[1].displacement = {"0.3*(1 - cos(4*t))", 0.0};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, AWallBeyondThePeriodOrBetweenTwo) {
  CaseSpec spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 2.0};
  spec.walls = {polyline({{0, 0}, {2, 0}}), polyline({{-0.4, 0.3}, {0.4, 0.3}})};
  spec.walls[1].name = "shelf";
  spec.walls[1].shape = WallShape::plate;
  spec.fluid = {box_fluid({0, 0}, {2, 0.6})};
  expect_among(check(spec), Severity::error, {"wall 'shelf' reaches from x = -0.4 to 0.4 m", "two parts"});
  spec.walls[1].points = {{0.0, 0.1}, {0.0, 0.4}};
  expect_among(check(spec), Severity::error, {"wall 'shelf' lies between two periods", "x = 0 m"});
  spec.walls[1].points = {{1.0, 0.0}, {1.0, 0.4}};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

// Between the water of two periods such a wall has no thickness.
TEST(Check, AWallAtAPeriodicBoundary) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.2, 1.2, 1}, {"+z"})};
  spec.walls[0].name = "tank";
  spec.fluid = {box_fluid({0, 0, 0}, {1.2, 1.2, 0.4})};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
  spec.domain.periodic_y = {0.0, 1.2};
  expect_among(check<3>(spec), Severity::error,
               {"wall 'tank' is only 0 m thick", "of the next period", "leave the wall out there"});
  spec.walls[0].open = {"-y", "+y", "+z"};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
  // Walls with their full thickness between two periods.
  spec.walls = {box_wall({0, 0.2, 0}, {1.2, 1.2, 1}, {"+z"})};
  spec.fluid = {box_fluid({0, 0.2, 0}, {1.2, 1.2, 0.4})};
  expect_among(check<3>(spec), Severity::error, {"is only 0.2 m thick", "of the next period"});
  spec.domain.periodic_y = {-0.1, 1.2};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
}

TEST(Check, DampingInATankThatMoves) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 0.8}, {0, 0}, {2, 0}, {2, 0.8}})};
  spec.fluid = {box_fluid({0, 0}, {2, 0.4})};
  DampingTable zone;
  zone.name = "sponge";
  zone.min = {1.0, 0.0};
  zone.max = {2.0, 0.8};
  zone.strength = 1.0;
  spec.damping = {zone};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.walls[0].displacement = {"0.1*sin(2*t)", 0.0};
  expect_only(check(spec), Severity::warning, {"'sponge' lies at wall 'wall1', which moves"});
}

// Water meets the face from the next period.
TEST(Check, ABlockWithAFaceInAPeriodicBoundary) {
  CaseSpec spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 2.0};
  spec.walls = {polyline({{0, 0}, {2, 0}}), box_wall({0, 0}, {0.6, 0.8}, {}, FluidSide::outside)};
  spec.fluid = {box_fluid({0.6, 0}, {2, 0.6})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.walls[1].open = {"-x"};
  expect_among(check(spec), Severity::error, {"the water can reach the back of wall 'wall2'"});
}

// Its wall particles would be wrapped into one period, hundreds on top of each other.
TEST(Check, AWallLongerThanThePeriod) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 0}, {2, 0}}), polyline({{500, 1}, {2, 1}})};
  spec.fluid = {box_fluid({0, 0}, {2, 0.4})};
  spec.domain.periodic_x = {0.0, 2.0};
  expect_among(check(spec), Severity::error, {"wall 'wall2' is 498 m long in x", "every 2 m", "draw one period"});
}

TEST(Check, ACrestAsHighAsTheEndsOfItsBed) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 0.5}, {0, 0}, {1, 0}, {1.5, 0.6}, {2, 0}, {3, 0}, {3, 0.5}})};
  spec.fluid = {box_fluid({0, 0}, {0.5, 0.3})};
  expect_only(check(spec), Severity::error, {"wall 'wall1' has a crest at (1.5, 0.6)", "0.1 m", "lower the crest"});
  spec.walls[0].points[3][1] = 0.4;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  // In a period the bed has no ends.
  spec.walls[0].points = {{0, 0.1}, {1, 0}, {1.5, 0.3}, {3, 0.1}};
  spec.fluid = {polygon_fluid({{0, 0.1}, {1, 0}, {1.5, 0.3}, {3, 0.1}, {3, 0.5}, {0, 0.5}})};
  spec.domain.periodic_x = {0.0, 3.0};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.domain.periodic_x.clear();
  spec.fluid = {box_fluid({0, 0}, {0.5, 0.3})};
  // A beach that is the end of its bed, and a bed that ends open.
  spec.walls = {polyline({{0, 0.5}, {0, 0}, {1, 0}, {3, 0.6}})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, WaterThatStartsInsideTheBed) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 0.5}, {0, 0}, {1, 0}, {1.5, 0.2}, {2, 0}, {3, 0}, {3, 0.5}})};
  spec.fluid = {box_fluid({0, 0}, {3, 0.3})};
  expect_among(check(spec), Severity::error, {"wall 'wall1'", "end the block on the bed", "(1.4", "polygon"});
}

/// A gate three spacings thick between two pools, on its path for 1 s.
CaseSpec gate_case(VectorField displacement) {
  CaseSpec spec = empty_case(0.05);
  spec.time.end = 1.0;
  spec.walls = {polyline({{0, 1}, {0, 0}, {2.15, 0}, {2.15, 1}}),
                box_wall({1, 0}, {1.15, 0.8}, {}, FluidSide::outside)};
  spec.walls[1].name = "gate";
  spec.walls[1].displacement = std::move(displacement);
  spec.fluid = {box_fluid({0, 0}, {1, 0.5}), box_fluid({1.15, 0}, {2.15, 0.1})};
  return spec;
}

TEST(CheckMotion, AGateThatOpensIsGood) {
  EXPECT_TRUE(check(gate_case({0.0, "1.5*max(0, t - 0.1)"})).empty());
  CaseSpec spec = empty_case(0.05, 3);
  spec.time.end = 1.0;
  spec.walls = {box_wall({0, 0, 0}, {2.15, 0.3, 1}, {"+z"}),
                box_wall({1, 0, 0}, {1.15, 0.3, 0.8}, {}, FluidSide::outside)};
  spec.walls[1].displacement = {0.0, 0.0, "1.5*t"};
  spec.fluid = {box_fluid({0, 0, 0}, {1, 0.3, 0.5})};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
}

TEST(CheckMotion, AGateThatSlidesAlongAWallIsGood) {
  CaseSpec spec = gate_case({0.0, "t"});
  spec.walls.push_back(box_wall({0.8, 0.8}, {1, 2}, {}, FluidSide::outside));  // a guide beside its way
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(CheckMotion, ATankThatMovesAsAWholeIsGood) {
  CaseSpec spec = tank();
  spec.time.end = 5.0;
  spec.walls = {polyline({{0.0, 0.6}, {0.0, 0.0}, {1.0, 0.0}}), polyline({{1.0, 0.0}, {1.0, 0.6}})};
  for (WallTable& wall : spec.walls) wall.rotation = "0.5*sin(3*t)";
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(CheckMotion, ASwingInDegreesIsTold) {
  CaseSpec spec = gate_case({0.0, 0.0});
  spec.time.end = 5.0;
  spec.walls.back().rotation = "4*sin(3*t)";
  expect_among(check(spec), Severity::warning, {"wall 'gate'", "rotation swings back and forth by 8 rad"});
  spec.walls.back().rotation = "4*t";
  for (const Finding& finding : check(spec)) EXPECT_EQ(finding.message().find("swings"), std::string::npos);
}

TEST(CheckMotion, NotWhereItIsDrawn) {
  expect_only(check(gate_case({0.0, "0.2 + t"})), Severity::error, {"wall 'gate'", "t = 0", "(0, 0.2)", "subtract"});
  expect_only(check(gate_case({0.1, 0.0})), Severity::error, {"wall 'gate'", "(0.1, 0)"});
}

TEST(CheckMotion, NotFinite) {
  expect_only(check(gate_case({0.0, "t < 0.5 ? t : sqrt(0.4 - t)"})), Severity::error,
              {"wall 'gate'", "no finite place", "t = 0.5"});
}

TEST(CheckMotion, TooFast) {
  expect_only(check(gate_case({0.0, "200*t"})), Severity::error, {"wall 'gate'", "150 m/s", "t = 0"});
  // A jump is faster than any speed.
  expect_only(check(gate_case({0.0, "t < 0.3 ? 0 : 0.1"})), Severity::error, {"wall 'gate'", "0.1 m", "t = 0.29"});
}

TEST(CheckMotion, ThroughAWall) {
  // The gate's side x = 1.15 reaches the wall x = 2.15 at t = 1/2; it may come as near as dx, which is at 0.475.
  expect_only(check(gate_case({"2*t", "min(t, 0.01)"})), Severity::error, {"wall 'gate'", "wall 'wall1'", "t = 0.4"});
  // Its foot is on the bed: down it goes through at once.
  expect_only(check(gate_case({0.0, "-0.1*t"})), Severity::error,
              {"wall 'gate' crosses wall 'wall1'", "t = 0.1", "(1", "change its path"});
}

TEST(CheckMotion, ClosingCrushesTheWater) {
  // Up by 0.3 m and down again: the foot is a spacing from the bed at t = 0.5 + 0.25/0.6.
  expect_only(check(gate_case({0.0, "0.6*min(t, 1 - t)"})), Severity::error,
              {"wall 'gate'", "wall 'wall1'", "compressed", "t = 0.9"});
  EXPECT_FALSE(has_error(check(gate_case({0.0, "0.6*min(t, max(1 - t, 0.1))"}))));
}

TEST(CheckMotion, RowsOnTheWallsMustNotLieInEachOther) {
  CaseSpec spec = gate_case({0.0, "1.5*t"});
  spec.scheme.name = SchemeName::farmani2020;
  spec.scheme.formulation = Formulation::published;
  spec.fluid = {box_fluid({0, 0}, {0.5, 0.5})};
  expect_only(check(spec), Severity::error, {"wall 'gate' is 0 m from wall 'wall1' at (1, 0)", "0.05 m", "robust"});
  spec.walls[1].min[1] = 0.05;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

/// A lid 1 m wide with its lower side at 0.8 m over 0.5 m of water, on its path for 1 s.
CaseSpec lid_case(VectorField displacement) {
  CaseSpec spec = empty_case(0.05);
  spec.time.end = 1.0;
  spec.walls = {polyline({{0, 1.2}, {0, 0}, {1, 0}, {1, 1.2}}), box_wall({0, 0.8}, {1, 1}, {}, FluidSide::outside)};
  spec.walls[1].name = "lid";
  spec.walls[1].displacement = std::move(displacement);
  spec.fluid = {box_fluid({0, 0}, {1, 0.5})};
  return spec;
}

TEST(CheckMotion, APistonThatCrushesTheWaterInAClosedBox) {
  // The water fills 200 cells. Where n rows of 20 have their middles below the lid it may have 20 n + (20 + 20 + 2 n)/2
  // of them, too few from n = 8 on: below 0.425 m, looked for every dx.
  expect_only(check(lid_case({0.0, "-0.43*t"})), Severity::error,
              {"wall 'lid' crushes the water at t = 0.", "at (0.5, 0.", "0.47 m^2", "0.5 m^2 of water"});
  EXPECT_TRUE(check(lid_case({0.0, "-0.29*t"})).empty());
  // It comes from above, into the open box.
  CaseSpec spec = lid_case({0.0, "-0.95*t"});
  spec.walls[1].min[1] = 1.3;
  spec.walls[1].max[1] = 1.5;
  expect_only(check(spec), Severity::error, {"wall 'lid' crushes the water at t = 0.9", "at (0.5, 0.3"});
  // Beside it the water gets out.
  spec.walls[1].min[0] = 0.1;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(CheckMotion, APistonThatCrushesTheWaterInAClosedBoxIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.time.end = 1.0;
  spec.walls = {box_wall({0, 0, 0}, {1, 1, 2}, {"+z"}), box_wall({0, 0, 1}, {1, 1, 1.4}, {}, FluidSide::outside)};
  spec.walls[1].displacement = {0.0, 0.0, "-0.8*t"};
  spec.fluid = {box_fluid({0, 0, 0}, {1, 1, 0.6})};
  expect_only(check<3>(spec), Severity::error, {"wall 'wall2' crushes the water", "m^3"});
  spec.walls[1].displacement = {0.0, 0.0, "-0.3*t"};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
}

TEST(CheckMotion, AWallThatEndsAtAMovingOneIsToldToGoOn) {
  CaseSpec spec = tank();
  spec.time.end = 1.0;
  spec.walls = {polyline({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.6}}), polyline({{0.0, 0.6}, {0.0, 0.0}})};
  spec.walls[1].displacement = {"0.2*t", 0.0};
  expect_only(check(spec), Severity::warning, {"wall 'wall1' ends at (0, 0)", "wall 'wall2'", "0.3 m"});
  spec.walls[0].points[0][0] = -0.3;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  // Rows of wall particles behind the farthest place of the piston: 0.2 m and three spacings.
  spec.walls[0].points[0][0] = 0.0;
  spec.walls[1].displacement = {"-0.2*t", 0.0};
  expect_among(check(spec), Severity::warning, {"wall 'wall1' ends at (0, 0)", "extend the resting wall by 0.5 m"});
}

/// A bed with a block in it, beside a wall, that moves by `rise` along y.
CaseSpec block_in_bed(double thickness, const std::string& rise) {
  CaseSpec spec = empty_case(0.1);
  spec.time.end = 1.0;
  spec.walls = {polyline({{1, 0}, {3, 0}, {3, 1}}), polyline({{0, 1}, {0, -thickness}}),
                polyline({{0, -thickness}, {0, 0}, {1, 0}, {1, -thickness}, {0, -thickness}})};
  spec.walls[2].name = "block";
  spec.walls[2].displacement = {0.0, rise};
  spec.fluid = {box_fluid({0, 0}, {3, 0.5})};
  return spec;
}

TEST(CheckMotion, ABlockOfTheBedThatRisesLeavesNoGapIfItsSideFollows) {
  EXPECT_TRUE(check(block_in_bed(1.0, "0.2*t")).empty()) << listed(check(block_in_bed(1.0, "0.2*t")));
  // The rise and three rows.
  EXPECT_TRUE(check(block_in_bed(0.5, "0.2*t")).empty()) << listed(check(block_in_bed(0.5, "0.2*t")));
  expect_only(check(block_in_bed(0.4, "0.2*t")), Severity::warning,
              {"wall 'wall1' ends at (1, 0)", "wall 'block' rises by 0.2 m", "side of the moving wall 0.5 m long"});
}

TEST(CheckMotion, ABlockOfTheBedThatSinksIsToldWhereTheBedHasToGoOn) {
  CaseSpec spec = block_in_bed(1.0, "-0.2*t");
  expect_only(check(spec), Severity::warning,
              {"wall 'wall1' ends at (1, 0)", "moves from there to (1, -0.2)", "from its end to (1, -0.5) or farther"});
  spec.walls[0].points.insert(spec.walls[0].points.begin(), {1.0, -0.5});
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, AnOutletIsNoLeak) {
  EXPECT_TRUE(check(open_channel()).empty()) << listed(check(open_channel()));
  CaseSpec full = open_channel();
  full.fluid = {box_fluid({0.0, 0.0}, {2.0, 0.4})};
  EXPECT_TRUE(check(full).empty()) << listed(check(full));
  CaseSpec closed_above = open_channel();
  closed_above.walls.push_back(polyline({{2.0, 0.8}, {0.0, 0.8}}));
  EXPECT_TRUE(check(closed_above).empty()) << listed(check(closed_above));

  CaseSpec low = open_channel();
  low.outlets = {outlet({2.0, 0.0}, {2.0, 0.2})};
  expect_only(check(low), Severity::error, {"would pour out"});
}

// Cells whose centres are as high as the tip look past it: they are in front of one face and behind the plane of the
// other.
TEST(Check, WaterLevelWithTheTipOfACrestIsNotBehindIt) {
  CaseSpec spec = empty_case(0.0625);
  const double tip = 5.5 * 0.0625;
  spec.walls = {
      polyline({{0.0, 1.0}, {0.0, 0.0}, {1.0 - tip, 0.0}, {1.0, tip}, {1.0 + tip, 0.0}, {2.0, 0.0}, {2.0, 1.0}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {0.5, 0.5})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

// Drawn as a line, a weir lets water through from behind.
TEST(Check, WaterBehindALineIsAnError) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0.0, 1.0}, {0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}}), polyline({{1.0, 0.2}, {1.0, 0.0}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {0.5, 0.4})};
  spec.walls[1].fluid_side = FluidSide::right;
  expect_only(check(spec), Severity::error, {"can reach the back of wall 'wall2'", "shape = \"plate\""});
  spec.walls[1].shape = WallShape::plate;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.scheme.formulation = Formulation::published;
  expect_among(check(spec), Severity::error, {"'wall2' is a plate", "\"robust\""});
}

// Water on both sides of a slanted plate, each nearer than dx/2 to the other.
TEST(Check, BlocksOnBothSidesOfAPlateMayBeNearEachOther) {
  CaseSpec spec = empty_case(0.05);
  spec.particles.jitter = 0.2;
  spec.walls = {polyline({{0, 1}, {0, 0}, {1, 0}, {1, 1}}), polyline({{0.4, 0}, {0.6, 1}})};
  spec.walls[1].shape = WallShape::plate;
  for (const double seed : {0.1, 0.9}) {
    FluidTable water;
    water.shape = BlockShape::fill;
    water.seed = {seed, 0.1};
    water.level = 0.8;
    spec.fluid.push_back(water);
  }
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

/// A boat 0.4 m long and 0.2 m high in the tank.
CaseSpec tank_with_boat() {
  CaseSpec spec = tank();
  WallTable box = box_wall({0.3, 0.3}, {0.7, 0.5}, {}, FluidSide::outside);
  box.name = "hull";
  box.drive = {Drive::By::body, 0};
  spec.walls.push_back(box);
  BodyTable body;
  body.name = "boat";
  body.walls = {"hull"};
  body.mass = 100.0;
  body.centre = {0.5, 0.4};
  body.inertia = {1.7};
  body.free = {"x", "y", "rotation"};
  body.velocity = {0.0, 0.0};
  spec.bodies = {body};
  return spec;
}

TEST(CheckMotion, ATankMayCarryAFloatingBody) {
  CaseSpec spec = tank_with_boat();
  spec.time.end = 2.0;
  spec.walls[0].displacement = {"t", 0.0};
  for (const Finding& finding : check(spec)) EXPECT_EQ(finding.message().find("comes closer"), std::string::npos);
}

TEST(Check, WhatIsFasterThanWaterCanBeIsRefused) {
  CaseSpec spec = tank_with_boat();
  spec.bodies[0].velocity = {0.0, 200.0};
  expect_among(check(spec), Severity::error, {"body 'boat': velocity is 200 m/s", "150 m/s"});
  CaseSpec channel = open_channel();
  channel.physics.gravity = {0.0, 0.0};
  channel.inlets = {inlet({0, 0}, {0, 0.8}, 1e6)};
  channel.walls = {polyline({{0, 0}, {2, 0}})};
  expect_among(check(channel), Severity::error, {"inlet 'inlet1'", "1.25e+06 m/s", "150 m/s"});
}

TEST(Check, ABodyHasItsMassWhereItsWallsAre) {
  CaseSpec spec = tank_with_boat();
  const auto told = [&] {
    return std::ranges::any_of(check(spec), [](const Finding& f) { return f.message().starts_with("body 'boat'"); });
  };
  EXPECT_FALSE(told()) << listed(check(spec));
  spec.bodies[0].inertia = {5.1};  // of the mass in its farthest corners 5
  expect_among(check(spec), Severity::warning, {"body 'boat' has an inertia of 5.1 kg m^2", "0.2236 m away"});
  spec.bodies[0].free = {"y"};
  EXPECT_FALSE(told()) << "it does not turn";
  spec.bodies[0].centre = {0.0, 0.1};  // as seen from its corner
  expect_among(check(spec), Severity::warning,
               {"body 'boat' has its centre of mass at (0, 0.1), outside of its walls"});
}

TEST(Check, SpringsAndDampersOfFixedMotionsAreReported) {
  CaseSpec spec = tank_with_boat();
  spec.bodies[0].free = {"y"};
  spec.bodies[0].springs = {0, 20, 0};
  for (const Finding& found : check(spec)) EXPECT_EQ(found.message().find("springs"), std::string::npos);
  spec.bodies[0].damping = {3, 0, 0};
  expect_among(check(spec), Severity::warning, {"body 'boat': damping has 3 for x", "add \"x\" to `free`"});
  spec.bodies[0].damping.clear();
  spec.bodies[0].extra_mass = {0, 0, 2};
  expect_among(check(spec), Severity::warning, {"body 'boat': extra_mass has 2 for rotation"});
}

TEST(Check, SpringsThatNeedManyMoreStepsThanTheWaterAreReported) {
  CaseSpec spec = tank_with_boat();
  const auto slow = [&] { return check_springs<2>(spec, make_fluid_particles<2>(spec, make_boundary<2>(spec))); };
  spec.bodies[0].springs = {0, 1e6, 0};  // period 0.063 s
  EXPECT_TRUE(slow().empty()) << listed(slow());
  spec.bodies[0].springs = {0, 1e12, 0};
  expect_only(slow(), Severity::warning,
              {"body 'boat': springs = 1e+12 moves its body with a period of 6.3e-05 s", "times as many steps"});
  spec.bodies[0].free = {"x"};
  EXPECT_TRUE(slow().empty()) << "the spring has no effect";
  MooringTable line;
  line.name = "chain";
  line.bodies = {"boat"};
  line.at = {0.5, 0.4};
  line.anchor = {0.0, 0.0};
  line.stiffness = 1e12;
  spec.moorings = {line};
  expect_only(slow(), Severity::warning, {"mooring 'chain': stiffness", "6.3e-05 s"});
}

TEST(Check, AFillThatLeavesASealedSpaceDryIsReported) {
  CaseSpec spec = tank();
  spec.particles.spacing = 0.02;
  WallTable bell;
  bell.name = "bell";
  bell.shape = WallShape::polygon;
  bell.fluid_side = FluidSide::outside;
  bell.points = {{0.3, 0.0}, {0.4, 0.0}, {0.4, 0.2}, {0.6, 0.2}, {0.6, 0.0}, {0.7, 0.0}, {0.7, 0.3}, {0.3, 0.3}};
  spec.walls.push_back(bell);
  FluidTable& water = spec.fluid[0];
  water.shape = BlockShape::fill;
  water.seed = {0.1, 0.1};
  water.level = 0.4;
  const auto sealed = [&] {
    const Boundary<2> boundary = make_boundary<2>(spec);
    return check_sealed_space<2>(spec, boundary, make_fluid_particles<2>(spec, boundary));
  };
  expect_only(sealed(), Severity::warning, {"fluid 'fluid1' leaves 0.04 m^2 at (0.4", "wall 'bell'"});
  spec.fluid.push_back(spec.fluid[0]);
  spec.fluid[1].name = "below";
  spec.fluid[1].seed = {0.5, 0.1};
  EXPECT_TRUE(sealed().empty()) << listed(sealed());
  spec.fluid.pop_back();
  for (Coordinates& corner : spec.walls[1].points) corner[1] += 0.1;  // off the bed
  EXPECT_TRUE(sealed().empty()) << listed(sealed());
}

TEST(Check, AMooringIsFastenedToItsBody) {
  CaseSpec spec = tank_with_boat();
  WallTable box = spec.walls.back();
  BodyTable body = spec.bodies[0];
  MooringTable line;
  line.name = "chain";
  line.bodies = {"boat"};
  line.at = {0.3, 0.1};  // below the hull, as on a keel
  line.anchor = {0.0, 0.0};
  spec.moorings = {line};
  const auto told = [&] {
    const Findings findings = check(spec);
    return std::ranges::any_of(findings, [](const Finding& f) { return f.message().starts_with("mooring 'chain'"); });
  };
  EXPECT_FALSE(told()) << listed(check(spec));
  spec.moorings[0].at = {56.7, 0.4};
  expect_among(check(spec), Severity::error, {"mooring 'chain' is fastened at (56.7, 0.4), 56 m from body 'boat'"});
  spec.moorings[0].at = {0.3, 0.1};
  spec.moorings[0].anchor = {0.0, 0.1};
  spec.moorings[0].length = 0.1;
  spec.moorings[0].stiffness = 60.0 * 9.81 * body.mass;  // N/m; the line is 0.2 m too short
  expect_among(check(spec), Severity::warning,
               {"mooring 'chain' is 0.1 m long and spans 0.3 m at the start: it pulls with 12 times the weight"});
  spec.moorings[0].at = {56.7, 0.4};
  box = box_wall({0.75, 0.3}, {0.95, 0.5}, {}, FluidSide::outside);
  box.name = body.name = "buoy";
  box.drive = {Drive::By::body, 1};
  spec.walls.push_back(box);
  body.walls = {"buoy"};
  body.centre = {0.85, 0.4};
  spec.bodies.push_back(body);
  spec.moorings[0].bodies = {"buoy", "boat"};
  spec.moorings[0].at = {0.8, 0.4};
  spec.moorings[0].anchor = {56.7, 0.4};
  expect_among(check(spec), Severity::error, {"mooring 'chain' is fastened at (56.7, 0.4), 56 m from body 'boat'"});
}

// A flap whose hinge is far above it, as in docs/guide/structures.md.
TEST(Check, AHingeFarFromItsBodyNeedsASmallWallThere) {
  CaseSpec spec = tank_with_boat();
  MooringTable line;
  line.name = "hinge";
  line.bodies = {"boat"};
  line.at = {0.3, 2.0};
  line.anchor = {0.3, 2.001};
  line.length = 0.001;
  line.stiffness = 1e4;
  spec.moorings = {line};
  const auto findings_of_hinge = [&] {
    Findings findings = check(spec);
    std::erase_if(findings, [](const Finding& f) { return !f.message().starts_with("mooring 'hinge'"); });
    return findings;
  };
  expect_only(findings_of_hinge(), Severity::error,
              {"mooring 'hinge' is fastened at (0.3, 2)", "for a hinge away from the body, name a small box there"});
  WallTable box = box_wall({0.2, 1.9}, {0.4, 2.1}, {}, FluidSide::outside);
  box.name = "box";
  box.drive = spec.walls.back().drive;
  spec.walls.push_back(box);
  spec.bodies[0].walls.push_back("box");
  EXPECT_TRUE(findings_of_hinge().empty()) << listed(findings_of_hinge());
}

TEST(Check, AProbeWhereNoWaterComesIsRefused) {
  ProbeTable probe;
  probe.name = "p";
  const auto check_probe = [&](Coordinates at, ProbeType type) {
    CaseSpec spec = tank();  // 1 m x 0.6 m
    probe.type = type;
    probe.at = probe.from = std::move(at);
    probe.to = probe.from;
    if (!probe.to.empty()) probe.to[1] += 0.5;
    spec.probes = {probe};
    return check(spec);
  };
  for (const ProbeType type : {ProbeType::pressure, ProbeType::velocity, ProbeType::discharge}) {
    EXPECT_TRUE(check_probe({0.5, 0.2}, type).empty());
    EXPECT_TRUE(check_probe({0.5, 0.9}, type).empty()) << "where it splashes";
    expect_only(check_probe({500, 0.2}, type), Severity::error,
                {"probe 'p' at (500, 0.2) is outside of the case", "between (0, 0) and (1, 0.6)"});
    expect_only(check_probe({0.5, -1.5}, type), Severity::error, {"probe 'p' at (0.5, -1.5)"});
  }
  // A tank that is driven to where the probe is.
  CaseSpec spec = tank();
  spec.walls[0].displacement = {"10*t", 0.0};
  spec.time.end = 1.0;
  probe.type = ProbeType::pressure;
  probe.at = {10.5, 0.2};
  spec.probes = {probe};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, AProbeOnAWallThatIsNotAtOneIsTold) {
  CaseSpec spec = tank();  // dx = 0.1 m
  ProbeTable probe;
  probe.name = "p";
  probe.type = ProbeType::wall_pressure;
  probe.at = {0.5, 0.09};
  spec.probes = {probe};
  EXPECT_TRUE(check(spec).empty()) << "a wall is known no better than a spacing";
  spec.probes[0].at = {0.5, 0.2};
  expect_only(check(spec), Severity::warning,
              {"probe 'p' at (0.5, 0.2) reads the pressure on the nearest wall, at (0.5, 0), 0.2 m away",
               "type = \"pressure\""});
}

TEST(Check, ADampingZoneWhereNoWaterComesIsRefused) {
  CaseSpec spec = tank();  // 1 m x 0.6 m
  DampingTable zone;
  zone.min = {0.9, 0.0};
  zone.max = {1.5, 1.0};
  zone.strength = 1.0;
  spec.damping = {zone};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.damping[0].min[0] = 1.1;
  expect_only(check(spec), Severity::error, {"damping from (1.1, 0) to (1.5, 1) is outside of the case"});
}

TEST(Check, DampingZonesThatOverlapAreReported) {
  CaseSpec spec = tank();  // 1 m x 0.6 m
  DampingTable zone;
  zone.name = "damping1";
  zone.min = {0.5, 0.0};
  zone.max = {1.0, 1.0};
  zone.strength = 1.0;
  spec.damping = {zone, zone};
  spec.damping[1].name = "damping2";
  spec.damping[1].min[0] = 0.8;
  expect_only(check(spec), Severity::warning,
              {"damping 'damping1' and damping 'damping2' overlap from (0.8, 0) to (1, 1)", "rates add"});
  spec.damping[1].towards = AxisDirection::plus_y;  // as in the corner of a basin
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.damping[1].towards = AxisDirection::minus_x;
  spec.damping[1].min[0] = 0.2;
  spec.damping[1].max[0] = 0.5;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

ProbeTable force_on(const std::vector<std::string>& walls) {
  ProbeTable probe;
  probe.name = "force";
  probe.type = ProbeType::force;
  probe.walls = walls;
  return probe;
}

TEST(Check, AForceThatWallsShareIsReported) {
  CaseSpec spec = tank();  // 1 m x 0.6 m
  spec.walls[0].name = "tank";
  spec.walls.push_back(polyline({{0.2, 0}, {0.8, 0}}));
  spec.walls[1].name = "plate";
  spec.probes = {force_on({"plate"})};
  expect_only(check(spec), Severity::warning,
              {"probe 'force' names wall 'plate' but not wall 'tank', which lies on it over 0.6 m", "name both walls"});
  spec.probes = {force_on({"plate", "tank"})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.probes = {force_on({})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

// A box on the bed faces it. Two boxes with a common part share their bottoms, where there is no water, and their tops.
TEST(Check, WallsThatTouchShareNoForce) {
  CaseSpec spec = tank();
  spec.particles.spacing = 0.01;
  spec.walls[0].name = "tank";
  for (const double left : {0.2, 0.3, 0.5}) {
    spec.walls.push_back(box_wall({left, 0}, {left + 0.2, 0.1}, {}, FluidSide::outside));
    spec.walls.back().name = "box" + std::to_string(spec.walls.size());
  }
  spec.fluid = {box_fluid({0, 0}, {1, 0.4})};
  for (const char* name : {"tank", "box4"}) {
    spec.probes = {force_on({name})};
    EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  }
  spec.probes = {force_on({"box2"})};  // its top is partly that of the second box
  expect_only(check(spec), Severity::warning, {"names wall 'box2' but not wall 'box3', which lies on it over 0.1 m"});
}

TEST(Check, AForceThatWallsShareIsReportedInSpace) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {2, 2, 1}, {"+z"}),
                box_wall({0.8, 0.8, 0}, {1.2, 1.2, 0.3}, {}, FluidSide::outside),
                box_wall({0, 0, 0}, {2, 2, 1}, {"+x", "-x", "+y", "-y", "+z"})};
  spec.walls[0].name = "tank";
  spec.walls[1].name = "pier";
  spec.walls[2].name = "floor";
  spec.fluid = {box_fluid({0, 0, 0}, {2, 2, 0.5})};
  spec.probes = {force_on({"pier"})};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
  spec.probes = {force_on({"floor"})};
  expect_only(check<3>(spec), Severity::warning, {"names wall 'floor' but not wall 'tank', which lies on it over"});
}

TEST(Check, AZoneThatIsTurnedOrTooLowIsReported) {
  CaseSpec spec = tank();  // 1 m x 0.6 m
  DampingTable zone;
  zone.min = {0.6, 0.0};
  zone.max = {1.0, 1.0};
  zone.strength = 1.0;
  spec.damping = {zone};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.damping[0].towards = AxisDirection::minus_x;
  expect_only(check(spec), Severity::warning, {"damping damps most at its -x side", "towards = \"+x\""});
  spec.damping[0] = zone;
  spec.damping[0].max[1] = 0.1;
  expect_only(check(spec), Severity::warning, {"damping ends 0.", "below the surface"});
}

TEST(Check, AZoneThatReflectsIsReported) {
  CaseSpec spec = tank();
  DampingTable zone;
  zone.min = {0.0, 0.0};
  zone.max = {1.0, 1.0};
  zone.period = 0.5;  // of waves 0.39 m long
  zone.depth = 0.3;
  spec.damping = {zone};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.damping[0].min[0] = 0.8;
  expect_only(check(spec), Severity::warning,
              {"damping is 0.2 m long, 0.51 of the wavelength: it reflects", "0.585 m long"});
}

TEST(Check, AZoneOfWavesFitsTheWaterAndTheTime) {
  CaseSpec spec = tank();
  spec.particles.spacing = 0.05;
  DampingTable zone;
  zone.min = {0.0, 0.0};
  zone.max = {1.0, 1.0};
  zone.waves = WaveKind::focused;
  zone.height = 0.12;
  zone.period = 0.5;
  zone.depth = 0.4;
  zone.level = 0.4;
  zone.focus = {3.0, 20.0};
  spec.damping = {zone};
  const auto fluid = make_fluid_particles<2>(spec, make_boundary<2>(spec));
  const auto found = [&] { return check_wave_zones<2>(spec, fluid); };
  EXPECT_TRUE(found().empty()) << listed(found());
  spec.damping[0].focus[1] = 7.0;  // in deep water groups take 4 pi x/(g T)
  expect_only(found(), Severity::error, {"focus = [3, 7]", "take 7.69 s", "at least 8.69 s"});
  spec.damping[0] = zone;
  spec.damping[0].level = 0.0;
  expect_only(found(), Severity::error, {"level = 0 m, but the surface of the water in the zone is at 0.4 m"});
}

TEST(Check, APlateThatAbsorbsBadlyIsReported) {
  CaseSpec spec = tank();
  WaveMakerTable maker;
  maker.name = "piston";
  maker.from = {0, 0};
  maker.to = {0, 1};
  maker.depth = 0.4;
  maker.waves = WaveKind::none;
  maker.absorption = Absorption::active;
  maker.period = 2.0;  // kh = 0.71: 1 %
  spec.wave_makers = {maker};
  const auto fluid = make_fluid_particles<2>(spec, make_boundary<2>(spec));
  EXPECT_TRUE(check_wave_makers<2>(spec, fluid).empty());
  spec.wave_makers[0].period = 0.7;
  expect_only(check_wave_makers<2>(spec, fluid), Severity::warning, {"wave_maker 'piston' reflects", "kh = 3.29"});
}

// The probe gets the pressure in the gap from the integral over the hull, which needs the spacing of the case there.
TEST(Check, AForceOnAHullBesideAZoneIsThatOfPairs) {
  constexpr double dx = 0.05;
  CaseSpec spec = empty_case(dx);
  spec.walls = {box_wall({0.0, 0.0}, {4.0, 1.0}, {"+y"}),
                box_wall({0.5, 2.0 * dx}, {1.0, 0.5}, {}, FluidSide::outside)};
  spec.walls[1].name = "block";
  spec.fluid = {box_fluid({0.0, 0.0}, {4.0, 0.8})};
  ProbeTable probe;
  probe.name = "force";
  probe.type = ProbeType::force;
  probe.walls = {"block"};
  spec.probes = {probe};
  RefinementTable zone;
  zone.min = {1.0 + 5.6 * dx, -1.0};
  zone.max = {10.0, 10.0};
  spec.refinement = {zone};
  const std::string pairs = "sum over pairs of particles";
  EXPECT_EQ(listed(check(spec)).find(pairs), std::string::npos);
  spec.refinement[0].min[0] = 1.0 + 5.4 * dx;
  expect_among(check(spec), Severity::warning, {"probe 'force'", "wall 'block'", pairs, "the gap to wall 'wall1'"});
  spec.probes[0].walls = {};  // on all walls
  EXPECT_EQ(listed(check(spec)).find(pairs), std::string::npos);
}

TEST(Check, ZonesOfRefinementAreRefusedWhereTheyDoNotWork) {
  CaseSpec spec = tank();  // 1 m x 0.6 m
  const double dx = spec.particles.spacing;
  RefinementTable zone;
  zone.name = "floor";
  zone.min = {-1.0, -1.0};
  zone.max = {2.0, 6.0 * dx};
  spec.refinement = {zone};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.refinement[0].max[1] = 3.0 * dx;
  expect_only(check(spec), Severity::error,
              {"refinement 'floor'", "no part of the zone would be as fine as prescribed"});
  spec.refinement[0].min[1] = 50.0;
  spec.refinement[0].max[1] = 60.0;
  expect_only(check(spec), Severity::error, {"refinement 'floor'", "would refine nothing"});
  spec.refinement = {zone};
  spec.scheme.name = SchemeName::farmani2020;
  expect_only(check(spec), Severity::error, {"do not work with scheme.name = \"farmani2020\""});
  spec.scheme.name = SchemeName::farzin2014;
  WallTable gate;
  gate.points = {{0.5, 0.0}, {0.5, 1.0}};
  gate.displacement = {0.0, "0.3*t"};
  spec.walls.push_back(gate);
  const std::string refused = "do not work with walls that move";
  EXPECT_NE(listed(check(spec)).find(refused), std::string::npos) << listed(check(spec));
  spec.refinement[0].max[1] = 9.0;  // the whole tank
  EXPECT_EQ(listed(check(spec)).find(refused), std::string::npos) << listed(check(spec));
  InletTable inlet;
  inlet.name = "spring";
  inlet.from = {0.0, 0.1};
  inlet.to = {0.0, 0.3};
  inlet.direction = {1.0, 0.0};
  inlet.discharge = "0.1";
  spec.inlets = {inlet};
  const std::string of_inlets = "do not work with inlets and outlets within 8 spacings of its border";
  EXPECT_EQ(listed(check(spec)).find(of_inlets), std::string::npos) << listed(check(spec));
  spec.refinement[0].max[1] = 0.5;  // its border reaches the inlet
  EXPECT_NE(listed(check(spec)).find(of_inlets), std::string::npos) << listed(check(spec));
}

TEST(Check, WaterOnABeachMayBeInAZone) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 2}, {0, 0}, {2, 0}, {12, 1}, {12, 2}})};
  FluidTable water = box_fluid({0, 0}, {1, 1});
  water.shape = BlockShape::fill;
  water.seed = {0.5, 0.25};
  water.level = 0.5;
  spec.fluid = {water};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  RefinementTable zone;
  zone.min = {3.0, -1.0};
  zone.max = {20.0, 9.0};
  zone.level = 2;
  spec.refinement = {zone};
  // As a run checks its case: with the cells of the case.
  const Boundary<2> boundary = make_boundary<2>(spec);
  const auto cells = make_fluid_particles<2>(spec, boundary, {}, 0, StartVelocities::left_out);
  const std::vector<Finding> found = check_geometry<2>(spec, boundary, cells);
  EXPECT_TRUE(found.empty()) << listed(found);
}

TEST(Check, ZonesWithADisplacementAreRefusedWhereTheyDoNotWork) {
  CaseSpec spec = tank();  // 1 m x 0.6 m
  RefinementTable zone;
  zone.name = "zone";
  zone.min = {-0.9, -1.0};
  zone.max = {0.1, 2.0};
  zone.displacement = {"0.5*t", 0.0};
  spec.refinement = {zone};
  spec.time.end = 1.0;
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.refinement[0].displacement = {"-0.5*t - 1", 0.0};
  expect_among(check(spec), Severity::error, {"refinement 'zone' is outside of the case"});
  spec.refinement[0].displacement = {"log(0.5 - t)", 0.0};
  expect_among(check(spec), Severity::error, {"refinement 'zone'", "displacement has no finite value at t = 0.5 s"});
  spec.refinement = {zone, zone};
  expect_among(check(spec), Severity::error, {"refinement 'zone' moves: a zone that moves must be the only one"});
  spec.refinement = {zone};
  WallTable plate;
  plate.name = "plate";
  plate.shape = WallShape::plate;
  plate.points = {{0.5, 0.0}, {0.5, 0.6}};
  plate.displacement = {0.0, "0.2*t"};
  spec.walls.push_back(plate);
  expect_among(check(spec), Severity::error, {"refinement 'zone' moves and comes within 8 spacings of wall 'plate'"});
}

TEST(Check, ZonesOfOtherShapesAreRefusedWhereTheyDoNotWork) {
  CaseSpec spec = tank();  // 1 m x 0.6 m
  const double dx = spec.particles.spacing;
  RefinementTable zone;
  zone.name = "zone";
  zone.shape = ZoneShape::polygon;
  zone.points = {{-1.0, -1.0}, {2.0, -1.0}, {2.0, 3.0 * dx}, {-1.0, 2.5 * dx}};
  spec.refinement = {zone};
  expect_only(check(spec), Severity::error,
              {"refinement 'zone'", "inwards from its edges", "4 m: no part of the zone"});
  spec.refinement[0].points = {{-1.0, -1.0}, {2.0, -1.0}, {2.0, 9.0 * dx}, {-1.0, 7.0 * dx}};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  zone.shape = ZoneShape::walls;
  zone.walls = {"gate"};
  zone.distance = 2.0 * dx;
  spec.refinement = {zone};
  WallTable gate;
  gate.name = "gate";
  gate.points = {{0.5, 0.0}, {0.5, 1.0}};
  spec.walls.push_back(gate);
  spec.walls.back().displacement = {0.0, 0.0};
  EXPECT_EQ(listed(check(spec)).find("refinement"), std::string::npos) << listed(check(spec));
  spec.walls.back().displacement = {0.0, "0.3*t"};
  expect_among(check(spec), Severity::error,
               {"refinement 'zone'", "less than the reach of particles beside walls that move"});
  spec.refinement[0].distance = 4.0 * dx;
  EXPECT_EQ(listed(check(spec)).find("refinement"), std::string::npos) << listed(check(spec));
  spec.refinement.push_back(zone);
  expect_among(check(spec), Severity::error, {"refinement 'zone' moves: a zone that moves must be the only one"});
  spec.refinement.pop_back();
  spec.refinement[0].walls.push_back(spec.walls[0].name = "tank");
  expect_among(check(spec), Severity::error, {"moves with wall 'gate', and 'tank' does not move with that wall"});
  spec.refinement[0].walls.pop_back();
  WallTable follower = spec.walls.back();
  follower.name = "follower";
  follower.points = {{0.6, 0.0}, {0.6, 1.0}};
  follower.displacement = {0.0, "0.2*t"};
  spec.walls.push_back(follower);
  expect_among(check(spec), Severity::error,
               {"refinement 'zone' moves and comes within 8 spacings of wall 'follower'"});
}

// Particles in cells that the slope cuts keep off it by a quarter of the local spacing.
TEST(Check, ASlopeInAZoneOfRefinementIsNotTooNear) {
  CaseSpec spec = empty_case(0.03, 2);
  FluidTable water;
  water.shape = BlockShape::fill;
  water.seed = {0.1, 0.1};
  water.level = 0.3;
  spec.fluid = {water};
  WallTable bed;
  bed.points = {{0.0, 0.6}, {0.0, 0.0}, {0.6, 0.0}, {2.4, 0.45}};
  bed.fluid_side = FluidSide::left;
  spec.walls = {bed};
  RefinementTable zone;
  zone.min = {0.9, -9.0};
  zone.max = {9.0, 9.0};
  for (const int level : {1, 2}) {
    zone.level = level;
    spec.refinement = {zone};
    EXPECT_EQ(listed(check(spec)).find("too near"), std::string::npos) << listed(check(spec));
  }
}

// Where the disc goes through the bed, its lower side is close below the bed, but dry.
TEST(Check, AWallIsNotTooThinWhereItCrossesAnother) {
  CaseSpec spec = tank();
  WallTable disc;
  disc.shape = WallShape::polygon;
  disc.fluid_side = FluidSide::outside;
  for (int k = 0; k < 24; ++k) {
    const double angle = k * std::numbers::pi / 12.0;
    disc.points.push_back({0.5 + 0.2 * std::cos(angle), 0.18 + 0.2 * std::sin(angle)});
  }
  spec.walls.push_back(disc);
  EXPECT_EQ(listed(check(spec)).find("thick"), std::string::npos) << listed(check(spec));
}

TEST(Check, ValuesOfAnotherUnitAreReported) {
  CaseSpec spec = tank();
  spec.physics.density = 1.0;
  expect_only(check(spec), Severity::warning, {"physics.density = 1 kg/m^3", "kg/l"});
  spec.physics.density = 1e6;
  expect_only(check(spec), Severity::warning, {"physics.density = 1e+06 kg/m^3", "g/m^3"});
  spec.physics.density = 1.36e4;  // mercury
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.physics.density = 1.0;
  spec.physics.gravity = {0.0, -1.0};  // a case without units
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec = tank();
  spec.physics.gravity = {0.0, -981.0};
  expect_only(check(spec), Severity::warning, {"physics.gravity = 981 m/s^2", "cm/s^2"});
  spec = tank();
  spec.physics.viscosity = 1.0;
  expect_only(check(spec), Severity::warning, {"physics.viscosity = 1 m^2/s", "mm^2/s"});
  spec.physics.viscosity = 0.001;
  expect_only(check(spec), Severity::warning, {"physics.viscosity = 0.001 m^2/s", "Pa s"});
  spec = tank();
  spec.physics.gravity = {0.0, -32.2};
  expect_only(check(spec), Severity::warning, {"physics.gravity = 32.2 m/s^2", "ft/s^2"});
  spec = tank();
  spec.air.pressure = 1.013;
  expect_only(check(spec), Severity::warning, {"air.pressure = 1.013 Pa", "bar"});
  spec = tank();
  LiquidTable oil;
  oil.name = "oil";
  oil.density = 0.9;
  oil.viscosity = 2e-6;
  fill_with(spec, oil);
  spec.physics.density = oil.density;
  expect_among(check(spec), Severity::warning, {"liquid 'oil': density = 0.9 kg/m^3", "kg/l"});
  expect_among(check(spec), Severity::warning, {"liquid 'oil': viscosity = 2e-06 Pa s", "m^2/s"});
}

// A yield stress of 20 Pa, a depth of 1 m or less and 100 Pa s make a creep of at most 0.1 m/s.
TEST(Check, ALiquidThatCreepsFarIsReported) {
  CaseSpec spec = tank();
  spec.time.end = 10.0;
  LiquidTable mud = bingham(1.0, 20.0);
  mud.name = "mud";
  mud.rest_viscosity = 1e6;
  fill_with(spec, mud);
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.liquids[0].rest_viscosity = 100.0;
  expect_only(check(spec), Severity::warning, {"liquid 'mud'", "rest_viscosity", "creeps at up to", "until the end"});
  spec.time.end_at_rest = 1e-3;
  expect_only(check(spec), Severity::warning, {"liquid 'mud'", "may not end at rest", "time.end_at_rest"});
}

TEST(Check, AStartAfterTheEndIsTold) {
  CaseSpec spec = tank();
  spec.time.end = 1.0;
  GateTable gate;
  gate.name = "weir";
  gate.start = 0.9;
  spec.gates = {gate};
  EXPECT_TRUE(check_late_starts(spec).empty());
  spec.gates[0].start = 2.0;
  WaveMakerTable maker;
  maker.name = "piston";
  maker.start = 1.0;
  spec.wave_makers = {maker};
  expect_among(check_late_starts(spec), Severity::warning, {"gate 'weir' begins to move at 2 s", "ends at 1 s"});
  expect_among(check_late_starts(spec), Severity::warning, {"wave_maker 'piston' begins to move at 1 s"});
  MeasurementTable record;
  record.probe = "gauge";
  record.file = "gauge.csv";
  record.series.time = {1.5, 2.0};
  spec.gates = {};
  spec.wave_makers = {};
  spec.measurements = {record};
  expect_only(check_late_starts(spec), Severity::warning, {"gauge.csv begins at 1.5 s", "'gauge'"});
  spec.measurements[0].series.time[0] = 0.5;
  EXPECT_TRUE(check_late_starts(spec).empty());
}

TEST(Check, AnIntervalOfFewReadingsIsReported) {
  CaseSpec spec = tank();
  spec.time.end = 1.0;
  ProbeTable probe;
  probe.name = "p";
  probe.type = ProbeType::pressure;
  probe.at = {0.5, 0.1};
  probe.interval = 0.1;
  spec.probes = {probe};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.probes[0].interval = 0.3;
  expect_only(check(spec), Severity::warning,
              {"probe 'p': interval = 0.3 s gives 4 readings in the run of 1 s", "0.1 s"});
  spec.probes[0].interval = 2.0;
  expect_only(check(spec), Severity::warning, {"probe 'p': interval = 2 s gives 1 reading, at the start,"});
  spec.probes[0].type = ProbeType::front;  // the result is its last reading
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

TEST(Check, TimesAfterTheEndAreTold) {
  CaseSpec spec = tank();
  spec.time.end = 1.0;
  ProbeTable probe;
  probe.name = "surface";
  probe.type = ProbeType::profile;
  probe.from = {0.0, 0.0};
  probe.to = {1.0, 0.0};
  probe.times = {0.5, 1.0, 7.5, 3.0};
  spec.probes = {probe};
  expect_only(check(spec), Severity::warning, {"probe 'surface': 2 of its 4 times are after time.end = 1 s", "7.5 s"});
  probe.times.clear();
  probe.type = ProbeType::pressure;
  probe.at = {0.5, 0.1};
  probe.averaging_time = 2.0;
  spec.probes = {probe};
  expect_only(check(spec), Severity::warning, {"probe 'surface': averaging_time = 2 s is longer than the run of 1 s"});
}

// A hundred walls that shake for a quarter of an hour: their way is 190 km.
TEST(CheckMotion, WaysThatAreTooLongAreFollowedAsFarAsTimeAllows) {
  CaseSpec spec = tank();
  spec.time.end = 1000.0;
  for (int k = 0; k < 100; ++k) {
    WallTable wall = box_wall({-10.0 - 3.0 * k, 5.0}, {-9.0 - 3.0 * k, 6.0}, {}, FluidSide::outside);
    wall.displacement = {fmt::format("0.01*sin(t*{})", k + 1), "0.3*sin(10*t)"};
    spec.walls.push_back(wall);
  }
  const std::clock_t start = std::clock();
  const std::vector<Finding> findings = check(spec);
  const char* slowdown = std::getenv("TAILWATER_SLOWDOWN");  // of a program with sanitizers
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10.0 * (slowdown ? std::atof(slowdown) : 1.0));
  expect_only(findings, Severity::warning, {"moves so far", "only checked up to t = "});
}

TEST(Check, ABodyThatReachesThroughTheBedDoesNoHarm) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0, 1}, {0, 0}, {3, 0}, {3, 1}}), box_wall({1.5, -0.03}, {2, 0.3}, {}, FluidSide::outside)};
  spec.fluid = {box_fluid({0, 0}, {1, 0.5})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.fluid = {box_fluid({0, 0}, {1, 0.6})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  CaseSpec in_3d = empty_case(0.1, 3);
  in_3d.walls = {box_wall({0, 0, 0}, {3, 2, 1}, {"+z"}),
                 box_wall({1.5, 0.6, -0.04}, {2, 1.4, 0.5}, {}, FluidSide::outside)};
  in_3d.fluid = {box_fluid({0, 0, 0}, {1, 2, 0.6})};
  EXPECT_TRUE(check<3>(in_3d).empty()) << listed(check<3>(in_3d));
}

/// A tank with a plate that ends above its bed, spacing 0.1 m.
CaseSpec tank_with_slot(double gap) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 1.5}, {0, 0}, {4, 0}, {4, 1.5}}), polyline({{2, gap}, {2, 1.4}})};
  spec.walls[1].shape = WallShape::plate;
  spec.fluid = {box_fluid({0, 0}, {2, 1})};
  return spec;
}

TEST(Check, AGapThatCountsAsClosedIsTold) {
  EXPECT_TRUE(check(tank_with_slot(0.0)).empty()) << listed(check(tank_with_slot(0.0)));
  expect_only(
      check(tank_with_slot(0.04)), Severity::warning,
      {"the gap of 0.04 m between wall 'wall2' and wall 'wall1' at (2, 0.04) counts as closed", "at most 0.008 m"});
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 1.5}, {0, 0}, {4, 0}, {4, 1.5}}), box_wall({2, 0.03}, {3, 1}, {}, FluidSide::outside)};
  spec.fluid = {box_fluid({0, 0}, {1.9, 0.8})};
  expect_among(check(spec), Severity::warning, {"the gap of 0.03 m between", "counts as closed"});
}

// Such a trough lost 2 to 42 % of its water in 2 s.
TEST(Check, AGapBetweenTwoPlatesIsNotClosed) {
  const auto trough = [](double gap) {
    CaseSpec spec = empty_case(0.1);
    spec.walls = {polyline({{0, 2.0}, {0, -1.0}, {4, -1.0}, {4, 2.0}}), polyline({{1, 1.5}, {1, gap}}),
                  polyline({{1 + gap, 0}, {3, 0}, {3, 1.5}})};
    spec.walls[1].shape = spec.walls[2].shape = WallShape::plate;
    spec.fluid = {box_fluid({1, 0}, {3, 1})};
    return spec;
  };
  for (const double gap : {0.0005, 0.005, 0.03}) {
    expect_only(
        check(trough(gap)), Severity::warning,
        {"between wall 'wall", "narrower than half a spacing, but water leaks", "let the plates end at the same"});
  }
  EXPECT_TRUE(check(trough(0.0)).empty()) << listed(check(trough(0.0)));
  expect_only(check(trough(0.06)), Severity::warning, {"the gap of 0.0849 m", "is 0.8 spacings wide"});
}

TEST(Check, AGapTooNarrowForItsWaterIsToldUntilTheSpacingIsThatOfTheMessage) {
  expect_only(check(tank_with_slot(0.06)), Severity::warning,
              {"the gap of 0.06 m between wall 'wall2' and wall 'wall1' at (2, 0.06) is 0.6 spacings wide",
               "a spacing of at most 0.012 m"});
  expect_only(check(tank_with_slot(0.48)), Severity::warning, {"is 4.8 spacings wide", "at most 0.096 m"});
  CaseSpec fine = tank_with_slot(0.48);
  fine.particles.spacing = 0.096;
  EXPECT_TRUE(check(fine).empty()) << listed(check(fine));
  // Under a gate that leans, beside a box, and between two plates in one line.
  CaseSpec leaning = tank_with_slot(0.2);
  leaning.walls[1].points = {{2, 0.2}, {3, 1.2}};
  leaning.fluid = {box_fluid({0, 0}, {1.5, 1})};
  expect_only(check(leaning), Severity::warning, {"the gap of 0.2 m", "is 2.0 spacings wide"});
  CaseSpec boxed = tank_with_slot(0.0);
  boxed.walls[1] = box_wall({2, 0.3}, {3, 1}, {}, FluidSide::outside);
  boxed.fluid = {box_fluid({0, 0}, {1.5, 0.8})};
  expect_only(check(boxed), Severity::warning, {"the gap of 0.3 m between", "is 3.0 spacings wide"});
  CaseSpec slit = tank_with_slot(0.0);
  slit.walls[1].points = {{2, 0}, {2, 0.5}};
  slit.walls.push_back(slit.walls[1]);
  slit.walls[2].points = {{2, 0.7}, {2, 1.4}};
  expect_only(check(slit), Severity::warning, {"the gap of 0.2 m between", "wall 'wall2'", "wall 'wall3'"});
}

// A gate that opened by less than half a spacing passed nothing, without a warning.
TEST(Check, AGapThatAGateLeavesWhereItStopsIsReported) {
  CaseSpec spec = tank_with_slot(0.0);
  spec.time.end = 1.0;
  spec.walls[1].displacement = {0.0, "min(t, 0.04)"};
  expect_only(check(spec), Severity::warning,
              {"the gap of 0.04 m between wall 'wall2' and wall 'wall1' at (2, 0.04) at the end of the run counts as "
               "closed"});
  spec.walls[1].displacement = {0.0, "min(t, 0.2)"};
  expect_only(check(spec), Severity::warning, {"the gap of 0.2 m", "at the end of the run is 2.0 spacings wide"});
  for (const char* opens_wide : {"min(t, 0.6)", "0.2*t"}) {  // or still moves
    spec.walls[1].displacement = {0.0, opens_wide};
    EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  }
}

// Walls that lean against each other are near each other at their corner, which is no gap.
TEST(Check, ACornerIsNoGap) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 1.5}, {0, 0}, {4, 0}}), polyline({{4, 0}, {2.5, 1.25}})};
  spec.fluid = {box_fluid({0, 0}, {2, 1})};
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
}

/// A flume so broad with a plate across it, its lower edge so high above the bed and its sides so far from the walls.
CaseSpec flume_with_slot(double breadth, double below, double beside) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {2, breadth, 2}, {"+z"})};
  spec.fluid = {box_fluid({0, 0, 0}, {1, breadth, 0.6})};
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.points = {{1, beside, below}, {1, breadth - beside, below}, {1, breadth - beside, 1.2}, {1, beside, 1.2}};
  spec.walls.push_back(plate);
  return spec;
}

WallTable named_plate(std::vector<Coordinates> points, std::string name) {
  WallTable wall = polyline(std::move(points));
  wall.shape = WallShape::plate;
  wall.name = std::move(name);
  return wall;
}

TEST(Check, PlatesThatLieOnEachOtherAreReported) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 1.5}, {0, 0}, {4, 0}, {4, 1.5}}), named_plate({{2, 0}, {2, 0.6}}, "a"),
                named_plate({{2, 0.3}, {2, 0.9}}, "b")};
  spec.fluid = {box_fluid({0, 0}, {2, 0.5})};
  expect_only(check(spec), Severity::warning, {"wall 'a' and wall 'b' lie on each other at (2, 0.35"});
  // Plates that cross or meet at their ends do not lie on each other.
  for (const WallTable& other : {named_plate({{2, 0.6}, {2, 1.2}}, "b"), named_plate({{2, 0.6}, {2.2, 1.2}}, "b")}) {
    spec.walls[2] = other;
    EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  }
}

TEST(Check, APlateAlongAWallIsRejected) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0, 1.5}, {0, 0}, {4, 0}, {4, 1.5}}), named_plate({{0, 0.2}, {0, 0.6}}, "a")};
  spec.fluid = {box_fluid({0, 0}, {4, 0.5})};
  expect_only(check(spec), Severity::error, {"wall 'a' lies along wall 'wall1' at (0, 0.25)", "remove this part"});
  spec.walls[1].displacement = {0.0, "0.1*t"};
  expect_among(check(spec), Severity::warning, {"wall 'a' lies along wall 'wall1'"});
  CaseSpec in_3d = flume_with_slot(0.8, 0.0, 0.0);
  in_3d.walls[1].points = {{0.5, 0.2, 0}, {1, 0.2, 0}, {1, 0.6, 0}, {0.5, 0.6, 0}};
  in_3d.fluid = {box_fluid({0, 0, 0}, {2, 0.8, 0.6})};
  expect_among(check<3>(in_3d), Severity::error, {"wall 'wall2' lies along wall 'wall1'"});
}

TEST(Check, AGapBesideAPlateIsToldIn3D) {
  expect_only(check<3>(flume_with_slot(0.8, 0.04, 0.0)), Severity::warning,
              {"the gap of 0.04 m between wall 'wall2' and wall 'wall1'", "counts as closed"});
  expect_only(check<3>(flume_with_slot(0.6, 0.4, 0.0)), Severity::warning, {"the gap of 0.4 m", "is 4.0 spacings"});
  expect_only(check<3>(flume_with_slot(2.0, 0.0, 0.3)), Severity::warning, {"the gap of 0.3 m", "is 3.0 spacings"});
  // The top edge of a weir in a flume six spacings broad is near the side walls, and water passes over it.
  const CaseSpec weir = flume_with_slot(0.6, 0.0, 0.0);
  EXPECT_TRUE(check<3>(weir).empty()) << listed(check<3>(weir));
}

// By rounding, the points of an edge are a hair beside the plates that it touches.
TEST(Check, PlatesThatMeetLeaveNoGapIn3D) {
  for (const double side : {0.7, 0.83, 1.1}) {
    CaseSpec spec = flume_with_slot(2.0, 0.0, 0.0);
    WallTable plate = spec.walls[1];
    plate.points = {{1, 0, 1.2}, {1, side, 1.2}, {1, side, 1.9}, {1, 0, 1.9}};
    spec.walls.push_back(plate);
    plate.points = {{1, side, 1.2}, {1, 2, 1.2}, {1, 2, 1.9}, {1, side, 1.9}};
    spec.walls.push_back(plate);
    EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
  }
}

TEST(Check, AnOutletIn3DIsNoLeak) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z", "+x"})};
  spec.fluid = {box_fluid({0, 0, 0}, {0.4, 0.5, 0.4})};
  spec.outlets = {outlet({1.0, 0.0, 0.0}, {1.0, 0.5, 0.6})};
  EXPECT_TRUE(check<3>(spec).empty()) << listed(check<3>(spec));
  spec.outlets = {outlet({1.0, 0.1, 0.0}, {1.0, 0.5, 0.6})};
  expect_among(check<3>(spec), Severity::error, {"'outlet1' leaves a gap to the walls", "(1, 0.1, "});
}

TEST(Check, AnOutletThatOverlapsAWallIsAnError) {
  CaseSpec closed = open_channel();
  closed.walls = {polyline({{0.0, 0.8}, {0.0, 0.0}, {2.0, 0.0}, {2.0, 0.8}})};
  expect_only(check(closed), Severity::error, {"outlet 'outlet1' overlaps wall 'wall1' at (2, ", "leave that piece"});
  CaseSpec crossed = open_channel();
  crossed.walls.push_back(box_wall({1.8, 0.35}, {2.5, 0.7}, {}, FluidSide::outside));
  expect_among(check(crossed), Severity::error, {"outlet 'outlet1' overlaps wall 'wall2'"});
}

TEST(Check, AnOutletThatCutsThroughWaterIsAnError) {
  CaseSpec spec = open_channel();
  spec.walls = {polyline({{0.0, 0.8}, {0.0, 0.0}, {3.0, 0.0}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {2.3, 0.4})};
  expect_among(check(spec), Severity::error, {"'outlet1' cuts through fluid 'fluid1': 12 particles", "(2.05, 0.05)"});
  CaseSpec backward = open_channel();
  backward.outlets[0].direction = {-1.0, 0.0};
  expect_only(check(backward), Severity::error, {"40 particles lie beyond it", "reverse its direction"});
}

TEST(Check, AnOutletOffTheWallsIsAnError) {
  CaseSpec gap = open_channel();
  gap.outlets = {outlet({2.0, 0.03}, {2.0, 0.8})};
  expect_among(check(gap), Severity::error, {"leaves a gap to the walls at (2, 0.03)", "(2, 0), 0.03 m away"});
  CaseSpec below = open_channel();
  below.outlets = {outlet({2.0, -0.03}, {2.0, 0.8})};
  expect_among(check(below), Severity::error, {"at (2, -0.03)", "0.03 m away"});
  CaseSpec outside = open_channel();
  outside.outlets = {outlet({5.0, 0.0}, {5.0, 0.8})};
  expect_among(check(outside), Severity::error, {"leaves a gap to the walls at (5, 0)", "3 m away"});
  CaseSpec no_wall = open_channel();
  no_wall.walls.clear();
  expect_only(check(no_wall), Severity::error, {"the case has no wall"});
}

TEST(Check, AnOutletInAPeriodicDirectionIsAnError) {
  CaseSpec spec = open_channel();
  spec.domain.periodic_x = {0.0, 2.0};
  expect_among(check(spec), Severity::error, {"'outlet1'", "lets water out in x", "periodic_x"});
}

/// A tank that a file moves to and fro, with 20 lines per period of 1 s.
CaseSpec shaken_tank() {
  CaseSpec spec = tank();
  spec.time.end = 2.0;
  TimeSeries& series = spec.walls[0].series;
  series.file = "shake.csv";
  series.columns.resize(4);
  for (int k = 0; k <= 40; ++k) {
    series.line.push_back(k + 2);
    series.time.push_back(0.05 * k);
    series.columns[0].push_back(0.3 * std::pow(std::sin(0.05 * k * 3.14159265), 2));
  }
  spec.walls[0].motion = series.file;
  return spec;
}

TEST(Check, ASmoothMotionOfAFileHasNoFindings) {
  EXPECT_TRUE(check(shaken_tank()).empty()) << listed(check(shaken_tank()));
}

TEST(Check, AFileThatJumpsIsRefusedWithItsLines) {
  CaseSpec spec = shaken_tank();
  for (std::size_t k = 13; k <= 40; ++k) spec.walls[0].series.columns[0][k] += 2.0;  // 40 m/s; sqrt(2 g L) is 2.8 m/s
  expect_only(check(spec), Severity::error,
              {"wall 'wall1' jumps between lines 14 and 15 of shake.csv", "0.05 s", "units"});
}

TEST(Check, AFileTooCoarseForItsMotionIsToldWithItsLines) {
  CaseSpec spec = shaken_tank();
  spec.walls[0].series.columns[0].assign(41, 0.0);
  for (std::size_t k = 20; k <= 40; ++k) spec.walls[0].series.columns[0][k] = 0.5;
  expect_only(check(spec), Severity::warning, {"wall 'wall1'", "beyond lines 2", "of shake.csv", "more lines there"});
}

TEST(Check, AFileThatDoesNotBeginWhereItsWallIsDrawnIsRefused) {
  CaseSpec spec = shaken_tank();
  for (double& x : spec.walls[0].series.columns[0]) x += 0.2;
  expect_only(check(spec), Severity::error, {"wall 'wall1' is not where it is drawn", "shake.csv", "(0.2, 0)"});
}

/// Channel from 0 to 2 m, 0.8 m high, open at both ends, with 0.4 m of water; one thing is prescribed at its inlet.
CaseSpec flume(const Varying& discharge = 0.1) {
  CaseSpec spec = open_channel();
  spec.walls = {polyline({{0.0, 0.0}, {2.0, 0.0}})};
  spec.fluid = {box_fluid({0.0, 0.0}, {2.0, 0.4})};
  spec.inlets = {inlet({0.0, 0.0}, {0.0, 0.8}, discharge)};
  spec.outlets[0].level = 0.4;
  spec.time.end = 10.0;
  return spec;
}

TEST(Check, AFlumeIsSound) { EXPECT_TRUE(check(flume()).empty()) << listed(check(flume())); }

TEST(Check, ACrestMayBeHigherThanTheBedAtOpenEnds) {
  CaseSpec spec = flume();
  spec.walls = {polyline({{0.0, 0.05}, {0.5, 0.0}, {1.0, 0.0}, {1.0, 0.2}, {1.4, 0.2}, {1.4, 0.0}, {2.0, 0.0}})};
  spec.inlets[0].from = {0.0, 0.05};
  spec.fluid.clear();
  for (const Finding& finding : check(spec)) EXPECT_EQ(finding.message().find("crest"), std::string::npos);
}

TEST(Check, AnOpenEndThatFacesTheWrongWayIsAnError) {
  CaseSpec spec = flume();
  spec.fluid.clear();
  spec.inlets[0].direction = {-1.0, 0.0};
  expect_only(check(spec), Severity::error, {"inlet 'inlet1' at (0, 0) faces the wrong way", "(-1, 0)", "opposite"});
  spec.inlets[0].direction = {1.0, 0.0};
  spec.outlets[0].direction = {-1.0, 0.0};
  expect_only(check(spec), Severity::error, {"outlet 'outlet1' at (2, 0) faces the wrong way"});
}

TEST(Check, AnInletInAWallOrOffTheBedIsAnError) {
  CaseSpec low = flume();
  low.inlets[0].from = {0.0, -0.2};
  expect_among(check(low), Severity::error, {"inlet 'inlet1'", "at (0, -0.2)", "0.2 m away"});
  CaseSpec closed = flume();
  closed.walls = {polyline({{0.0, 0.8}, {0.0, 0.0}, {2.0, 0.0}})};
  expect_among(check(closed), Severity::error, {"inlet 'inlet1' overlaps wall 'wall1' at (0, "});
}

TEST(Check, AZoneThatBrakesTheFlowIsReported) {
  CaseSpec spec = flume();
  DampingTable zone;
  zone.min = {1.0, 0.0};
  zone.max = {2.0, 0.8};
  zone.strength = 1.0;
  spec.damping = {zone};
  const auto fluid = make_fluid_particles<2>(spec, make_boundary<2>(spec));
  expect_only(check_wave_zones<2>(spec, fluid), Severity::warning,
              {"damping lies between inlet 'inlet1' and outlet 'outlet1'", "give `transport`"});
  spec.damping[0].transport = 0.5;
  EXPECT_TRUE(check_wave_zones<2>(spec, fluid).empty());
  EXPECT_EQ(WaveZone<2>(spec, spec.damping[0]).target({1.5, 0.2}, 0.0), Vec<2>(0.5, 0.0));
}

TEST(Check, WhatAnInletCannotPassIsAnError) {
  // Critical depth cbrt(q^2/g): 0.8 m at q = 2.24 m^2/s.
  EXPECT_TRUE(check(flume(2.2)).empty()) << listed(check(flume(2.2)));
  expect_only(check(flume(2.3)), Severity::error,
              {"inlet 'inlet1'", "more water enters than the opening can pass", "0.8 m high", "1 l/s is 0.001"});
  CaseSpec fast = flume();
  fast.inlets[0].discharge.reset();
  fast.inlets[0].velocity = 3.0;  // critical at 0.92 m
  expect_only(check(fast), Severity::error, {"more water enters", "give a supercritical flow its level too"});
  fast.inlets[0].level = 0.4;
  EXPECT_TRUE(check(fast).empty()) << listed(check(fast));
  fast.inlets[0].velocity = 50.0;
  expect_only(check(fast), Severity::error, {"at 50 m/s, which is implausible", "a velocity in m/s"});
  fast.inlets[0].velocity = 1.0;
  expect_only(check(fast), Severity::error, {"level is given, but the flow is subcritical", "remove the level"});
}

// The flow is critical at 0.094 m where it is free to be so. Water that cannot sink below a spacing dams it.
TEST(Check, AThinInflowIsReportedWhereNothingDamsIt) {
  CaseSpec spec = flume(0.09);
  EXPECT_TRUE(check(spec).empty()) << "0.4 m of water, and the level beyond: " << listed(check(spec));
  const auto expect_warning = [&] {
    expect_only(check(spec), Severity::warning,
                {"the critical depth of the inflow is 0.0938 m at most, less than the spacing of 0.1 m"});
  };
  spec.outlets[0].level = "0.4 - 0.035*t";
  expect_warning();
  spec.outlets[0].level.reset();
  expect_warning();
  spec.outlets.clear();
  spec.walls = {polyline({{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}})};
  EXPECT_TRUE(check(spec).empty()) << "a basin: " << listed(check(spec));
  spec.fluid = {box_fluid({1.5, 0.0}, {2.0, 0.4})};
  expect_among(check(spec), Severity::warning, {"the critical depth of the inflow is 0.0938 m"});
}

TEST(Check, ALevelOutsideItsOpeningIsAnError) {
  CaseSpec spec = flume();
  spec.outlets[0].level = "0.4 + 0.05*t";
  expect_only(check(spec), Severity::error,
              {"outlet 'outlet1': level = 0.8", "is above the top of the opening, 0.8 m"});
  spec.outlets[0].level = -0.1;
  expect_only(check(spec), Severity::error, {"level = -0.1 m at t = 0 s is below the lowest point", "not depths"});
}

TEST(Check, ALevelThatTheDischargeTakesOutOfItsOpeningIsReported) {
  CaseSpec spec = flume(0.5);
  spec.outlets[0].level = "0.3 + 0.8*q";
  EXPECT_TRUE(check(spec).empty()) << listed(check(spec));
  spec.outlets[0].level = "0.3 + 1.1*q";
  expect_only(check(spec), Severity::warning,
              {"outlet 'outlet1': level = 0.8", "is above the top of the opening", "up to 0.5 m^2/s flow in"});
  spec.outlets[0].level = "0.6 - 0.2*q";
  expect_only(check(spec), Severity::warning,
              {"outlet 'outlet1': level falls from 0.6 m to 0.595 where q grows to 0.025 m^2/s", "grows with q"});
  spec.outlets[0].level = "0.3 + sqrt(0.1 - q)";
  expect_among(check(spec), Severity::warning, {"level falls"});
  spec.outlets[0].level = "q < 0.2 ? 0.3 : sqrt(0.1 - q)";
  expect_only(check(spec), Severity::error, {"level has no finite value at q = 0.2 m^2/s", "up to 0.5 m^2/s"});
}

TEST(Check, ASeriesThatIsTooShortOrJumpsIsAnError) {
  CaseSpec spec = flume();
  spec.inlets[0].discharge.reset();
  spec.inlets[0].series = {"hydrograph.csv", {2, 3}, {0.0, 8.0}, {{0.1, 0.2}, {}, {}}};
  expect_only(check(spec), Severity::error,
              {"inlet 'inlet1': file covers t = 0 to 8 s", "time.end = 10 s", "add rows"});
  spec.inlets[0].series.time = {1.0, 12.0};
  expect_only(check(spec), Severity::error, {"file covers t = 1 to 12 s"});
  spec.inlets[0].series = {"hydrograph.csv", {2, 3, 4}, {0.0, 5.0, 5.01, 12.0}, {{0.1, 0.1, 0.3, 0.3}, {}, {}}};
  expect_only(check(spec), Severity::error, {"inlet 'inlet1': discharge jumps by", "let it change over"});
  expect_only(check(flume("t < 3 ? 0.1 : 0.5")), Severity::error, {"discharge jumps by 0.4 m^3/s between t = "});
}

}  // namespace
}  // namespace tailwater
