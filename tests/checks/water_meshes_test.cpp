// Blocks of water that are meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "checks/check.h"
#include "geometry/boundary.h"
#include "geometry/mesh_surface.h"
#include "geometry/meshes.h"
#include "sampling/fluid_particles.h"

namespace tailwater {
namespace water_meshes_test {

using namespace testing_cases;

constexpr double dx = 0.125;  // lengths that mesh files hold exactly

FluidTable mesh_water(const MeshFolder& folder, const TriangleMesh& mesh, const std::string& name = "water.stl") {
  FluidTable block;
  block.shape = BlockShape::mesh;
  block.file = folder.write(name, binary_stl(mesh));
  return block;
}

/// A tank of 4 m x 3 m x 3 m that is open above.
CaseSpec tank_with(const FluidTable& block) {
  CaseSpec spec = empty_case(dx, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {4.0, 3.0, 3.0}, {"+z"})};
  spec.fluid = {block};
  return spec;
}

FluidParticles<3> water_of(const CaseSpec& spec) { return make_fluid_particles(spec, make_boundary<3>(spec)); }

double total_volume(const FluidParticles<3>& fluid) {
  double volume = 0.0;
  for (const double v : fluid.volume) volume += v;
  return volume;
}

std::string refusal_of(const CaseSpec& spec) {
  try {
    const Boundary<3> boundary = make_boundary<3>(spec);
    std::string text;
    for (const Finding& finding : check_geometry(spec, boundary, make_fluid_particles(spec, boundary))) {
      text += finding.message() + "\n";
    }
    return text;
  } catch (const InputError& error) {
    return error.what();
  }
}

void expect_refused(const CaseSpec& spec, const std::vector<std::string>& words) {
  const std::string message = refusal_of(spec);
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
}

TEST(WaterMesh, OfABoxIsTheBlock) {
  const MeshFolder folder;
  const Vec<3> low(0.0, 0.0, 0.0);
  // In z no whole number of spacings.
  const Vec<3> high(2.0, 3.0, 1.1875);
  const FluidTable block = box_fluid({0.0, 0.0, 0.0}, {2.0, 3.0, 1.1875});
  const WallTable body = box_wall({0.75, 1.0, 0.0}, {1.5, 2.0, 0.5}, {}, FluidSide::outside);
  for (const bool has_body : {false, true}) {
    CaseSpec with_block = tank_with(block);
    CaseSpec with_mesh = tank_with(mesh_water(folder, box_mesh(low, high)));
    if (has_body) {
      with_block.walls.push_back(body);
      with_mesh.walls.push_back(body);
    }
    const FluidParticles<3> expected = water_of(with_block);
    const FluidParticles<3> found = water_of(with_mesh);
    ASSERT_EQ(found.position.size(), expected.position.size());
    for (std::size_t i = 0; i < found.position.size(); ++i) {
      EXPECT_LT((found.position[i] - expected.position[i]).norm(), 1e-12);
      EXPECT_NEAR(found.volume[i], expected.volume[i], 1e-12 * expected.volume[i]);
    }
    EXPECT_EQ(refusal_of(with_mesh), "");
  }
}

// A ball that falls into the tank, and a bent channel whose floor has two heights.
TEST(WaterMesh, HasItsVolumeToRoundOffAndNothingOutside) {
  const MeshFolder folder;
  const TriangleMesh ball = sphere_mesh({2.0, 1.5, 1.5}, 0.8, 24);
  const MeshSurface surface(ball);
  const CaseSpec spec = tank_with(mesh_water(folder, ball));
  const FluidParticles<3> fluid = water_of(spec);
  ASSERT_GT(fluid.position.size(), 1000u);
  const double volume = std::abs(six_volumes(ball, [](int) { return true; })) / 6.0;
  EXPECT_NEAR(total_volume(fluid), volume, 1e-7 * volume);  // the file has seven digits
  EXPECT_NEAR(total_volume(fluid), six_volumes(make_boundary<3>(spec).water[0]->mesh(), [](int) { return true; }) / 6.0,
              1e-13);
  for (const Vec<3>& x : fluid.position) {
    EXPECT_LE(surface.nearest(x, std::numeric_limits<double>::infinity()).signed_distance, 1e-7);
  }
}

TEST(WaterMesh, IsDividedAtItsOwnSteps) {
  const MeshFolder folder;
  // Two boxes as one body: a step of 0.3 m, no whole number of spacings, in its top.
  TriangleMesh step;
  for (const double y : {0.0, 3.0}) {
    for (const auto& [x, z] : {std::pair{0.0, 0.0}, {4.0, 0.0}, {4.0, 1.0}, {2.0, 1.0}, {2.0, 1.3125}, {0.0, 1.3125}}) {
      step.points.emplace_back(x, y, z);
    }
  }
  for (int k = 0; k < 6; ++k) add_quad(step, k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k);
  const auto add_sides = [&](int a, int b, int c) {
    step.triangles.push_back({a, c, b});
    step.triangles.push_back({6 + a, 6 + b, 6 + c});
  };
  add_sides(0, 1, 3);
  add_sides(1, 2, 3);
  add_sides(0, 3, 5);
  add_sides(3, 4, 5);
  const CaseSpec spec = tank_with(mesh_water(folder, step));
  const FluidParticles<3> fluid = water_of(spec);
  EXPECT_NEAR(total_volume(fluid), 3.0 * (4.0 * 1.0 + 2.0 * 0.3125), 1e-9);
  double highest_of_low_half = 0.0;
  for (const Vec<3>& x : fluid.position) {
    if (x[0] > 2.0) highest_of_low_half = std::max(highest_of_low_half, x[2]);
  }
  EXPECT_NEAR(highest_of_low_half, 1.0 - 0.5 * dx, 1e-9);
}

TEST(WaterMesh, ThatCannotBeIsRefused) {
  const MeshFolder folder;
  const auto box = [](double x, double side) { return box_mesh(Vec<3>(x, 0.0, 0.0), Vec<3>(x + side, side, side)); };
  TriangleMesh open = box(0.0, 1.0);
  open.triangles.pop_back();
  expect_refused(tank_with(mesh_water(folder, open)),
                 {"fluid 'fluid1': file ", "water.stl", "not watertight", "3 edges", "close the mesh"});
  expect_refused(tank_with(mesh_water(folder, box(0.0, 1000.0))),
                 {"water.stl", "reaches from (0, 0, 0) to (1000, 1000, 1000)", "0.001 for a file in millimetres"});
  expect_refused(tank_with(mesh_water(folder, box(0.0, 0.0625))), {"water.stl", "too small or too thin"});
  expect_refused(tank_with(mesh_water(folder, box(3.5, 1.0))), {"fluid 'fluid1'", "particles", "wall 'wall1'"});
  expect_refused(tank_with(mesh_water(folder, box(4.5, 1.0))), {"fluid 'fluid1' lies behind wall 'wall1'"});
  CaseSpec in_body = tank_with(mesh_water(folder, box_mesh({1.0, 1.0, 1.0}, {2.0, 2.0, 2.0})));
  in_body.walls.push_back(box_wall({0.5, 0.5, 0.0}, {2.5, 2.5, 2.5}, {}, FluidSide::outside));
  expect_refused(in_body, {"fluid 'fluid1' holds no particle", "in walls and bodies"});
  TriangleMesh crossed = box_mesh({1.0, 1.0, 1.0}, {2.0, 2.0, 2.0});
  const TriangleMesh other = box_mesh({1.75, 1.25, 1.25}, {2.25, 1.75, 1.75});
  for (const auto& t : other.triangles) crossed.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  crossed.points.insert(crossed.points.end(), other.points.begin(), other.points.end());
  expect_refused(tank_with(mesh_water(folder, crossed)), {"fluid 'fluid1' crosses itself at", "unite the bodies"});
}

}  // namespace water_meshes_test
}  // namespace tailwater
