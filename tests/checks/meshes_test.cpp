// Checks of walls from meshes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <utility>

#include "checks/check.h"
#include "checks/checks.h"
#include "geometry/meshes.h"

namespace tailwater {
namespace {

using namespace testing_cases;

TEST(CheckMeshes, FindsWrongUnitsCrossingsAndPlates) {
  const MeshFolder folder;
  const auto errors = [&](const TriangleMesh& mesh, double scale = 1.0) {
    CaseSpec spec = case_with(folder.wall(mesh, FluidSide::outside));
    spec.walls[0].scale = scale;
    const Boundary<3> boundary = make_boundary<3>(spec);
    std::string text;
    for (const Finding& finding : check_meshes(spec, boundary, make_fluid_particles(spec, boundary))) {
      text += finding.message() + "\n";
    }
    return text;
  };
  EXPECT_EQ(errors(unit_box()), "");
  EXPECT_EQ(errors(sphere_mesh(Vec<3>::Zero(), 0.5, 16)), "");
  expect_words(errors(box_mesh({5.0, 0.0, 0.0}, {1005.0, 200.0, 300.0})),
               {"wall 'wall1' is 1000 m long and the water 3 m", "scale = 0.001"});
  expect_words(errors(unit_box(), 0.001), {"is 0.001 m long, less than a spacing of 0.1 m"});
  expect_words(errors(box_mesh({0.0, 0.0, 0.0}, {1.0, 1.0, 0.25})), {"only 0.25 m thick at", "need 0.3 m"});
  TriangleMesh two = unit_box();
  const TriangleMesh other = box_mesh({0.5, 0.5, 0.5}, {1.5, 1.6, 1.7});
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  two.points.insert(two.points.end(), other.points.begin(), other.points.end());
  expect_words(errors(two), {"crosses itself at (", "unite the bodies"});
}

/// A channel 1.6 m long along x with a bed 0.2 m wide and banks of 45 degrees, 0.3 m high.
TriangleMesh trapezoid() {
  TriangleMesh channel;
  for (const double x : {0.0, 1.6}) {
    for (const auto& [y, z] : {std::pair{-0.4, 0.3}, {-0.1, 0.0}, {0.1, 0.0}, {0.4, 0.3}}) {
      channel.points.emplace_back(x, y, z);
    }
  }
  for (int k = 0; k < 3; ++k) {
    channel.triangles.push_back({k, k + 4, k + 5});
    channel.triangles.push_back({k, k + 5, k + 1});
  }
  return channel;
}

// Critical flow 0.27 m deep has the discharge sqrt(g A^3/B) = 0.165 m^3/s, with A = 0.27 m (0.2 m + 0.27 m), B = 0.74
// m.
TEST(CheckMeshes, ADischargeInLitresThroughASectionIsAnError) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.03, 3);
  spec.walls = {folder.wall(trapezoid(), FluidSide::above)};
  InletTable river;
  river.direction = {1.0, 0.0, 0.0};
  river.through = {0.0, 0.0, 0.27};
  spec.inlets = {river};
  const Boundary<3> boundary = make_boundary<3>(spec);
  const auto fluid = make_fluid_particles(spec, boundary);
  for (const double discharge : {0.15, 0.18, 15.0}) {
    spec.inlets[0].discharge = discharge;
    const Findings findings = check_end_flows(spec, boundary, fluid);
    ASSERT_EQ(findings.size(), discharge < 0.165 ? 0u : 1u) << discharge;
    if (!findings.empty()) expect_words(findings[0].message(), {"more water enters than the opening can pass"});
  }
}

// Centres of cells lie on banks of 45 degrees, on either side of a triangle by the rounding of the file.
TEST(CheckMeshes, BanksOf45DegreesHoldTheWater) {
  const MeshFolder folder;
  for (const double spacing : {0.02, 0.025, 0.03}) {
    CaseSpec spec = empty_case(spacing, 3);
    spec.walls = {folder.wall(trapezoid(), FluidSide::above)};
    FluidTable water;
    water.shape = BlockShape::fill;
    water.seed = {0.8, 0.0, 0.1};
    water.level = 0.16;
    spec.fluid = {water};
    for (const double x : {0.0, 1.6}) {
      OutletTable end;
      end.name = fmt::format("end_{}", x);
      end.direction = {x == 0.0 ? -1.0 : 1.0, 0.0, 0.0};
      end.through = {x, 0.0, 0.27};
      end.level = 0.16;
      spec.outlets.push_back(end);
    }
    const Boundary<3> boundary = make_boundary<3>(spec);
    const Findings leaks = check_leaks(spec, boundary, make_fluid_particles(spec, boundary));
    EXPECT_TRUE(leaks.empty()) << spacing << ": " << leaks.front().message();
  }
}

// A tank of 3 m with a body inside it, then beside it, then so large that the tank is inside the body.
TEST(CheckMeshes, WarnOfABodyBesideTheRestOrLongerThanIt) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {folder.wall(unit_box(), FluidSide::outside), box_wall({-1, -1, -1}, {2, 2, 2}, {"+z"})};
  spec.fluid = {box_fluid({-1, -1, -1}, {2, 2, 1.5})};
  const auto found = [&] {
    const Boundary<3> boundary = make_boundary<3>(spec);
    return check_meshes(spec, boundary, make_fluid_particles(spec, boundary));
  };
  EXPECT_TRUE(found().empty());
  spec.walls[0].translate = {5.0, 0.0, 0.0};
  Findings findings = found();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  expect_words(findings[0].message(),
               {"wall 'wall1': file ", "mesh.stl reaches from (5, 0, 0) to (6, 1, 1)",
                "from (-1, -1, -1) to (2, 2, 2), so it stands beside them", "correct translate"});
  spec.walls[0].translate = {-4.0, -4.0, 0.0};
  spec.walls[0].scale = 8.0;
  findings = found();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  expect_words(findings[0].message(),
               {"is a body 8 m long, and water and walls have a length of 3 m", "0.001 for a file in mill"});
}

// Water that has just left a nozzle stands in front of the mesh around it, and touches only the opening.
TEST(CheckMeshes, AMeshAroundAnOpeningIsNotBesideTheRest) {
  const MeshFolder folder;
  TriangleMesh plane;  // x = 0 around a square hole
  for (const double half : {0.2, 0.6}) {
    for (const auto& [y, z] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}}) {
      plane.points.emplace_back(0.0, y, z);
    }
  }
  for (int k = 0; k < 4; ++k) add_quad(plane, k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4);
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {folder.wall(plane, FluidSide::front)};
  spec.fluid = {box_fluid({0.2, -0.2, -0.2}, {0.4, 0.2, 0.2})};
  const auto count = [&] {
    const Boundary<3> boundary = make_boundary<3>(spec);
    return check_meshes(spec, boundary, make_fluid_particles(spec, boundary)).size();
  };
  EXPECT_EQ(count(), 1u) << "no opening";
  spec.fluid[0].min[0] = 0.0;
  EXPECT_EQ(count(), 0u) << "water on the mesh";
  spec.fluid[0].min[0] = 0.2;
  InletTable inlet;
  inlet.from = {0.0, -0.2, -0.2};
  inlet.to = {0.0, 0.2, 0.2};
  inlet.direction = {1.0, 0.0, 0.0};
  spec.inlets = {inlet};
  EXPECT_EQ(count(), 0u);
}

TEST(CheckMeshes, AWayThatCutsThroughABodyIsNotBehindIt) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {1.6, 1.6, 2.0}, {"+z"}),
                folder.wall(sphere_mesh({0.831, 0.812, 0.822}, 0.5, 48), FluidSide::outside)};
  spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {1.6, 1.6, 1.6})};
  const Boundary<3> boundary = make_boundary<3>(spec);
  for (const Finding& finding : check_geometry(spec, boundary, make_fluid_particles(spec, boundary))) {
    EXPECT_EQ(finding.severity, Severity::warning) << finding.message();
  }
}

TEST(CheckFill, OfABoxTankThatDxDoesNotDivideHasNoFindings) {
  CaseSpec spec = empty_case(0.0275, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {3.22, 1.0, 1.0}, {"+z"})};
  FluidTable fill;
  fill.shape = BlockShape::fill;
  fill.seed = {0.5, 0.5, 0.2};
  fill.level = 0.55;
  for (const FluidTable& water : {fill, box_fluid({1.992, 0.0, 0.0}, {3.22, 1.0, 0.55})}) {
    spec.fluid = {water};
    const Boundary<3> boundary = make_boundary<3>(spec);
    for (const Finding& finding : check_geometry(spec, boundary, make_fluid_particles(spec, boundary))) {
      ADD_FAILURE() << finding.message();
    }
  }
}

}  // namespace
}  // namespace tailwater
