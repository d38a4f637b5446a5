// Water that is poured in at a point.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "base/box.h"
#include "base/error.h"
#include "geometry/boundary.h"
#include "geometry/meshes.h"
#include "sampling/fluid_particles.h"

namespace tailwater {
namespace fill_test {
namespace {

using namespace testing_cases;

constexpr double infinite = std::numeric_limits<double>::infinity();

TEST(Fill, OfABoxTankThatDxDoesNotDivideIsItsWholeVolume) {
  CaseSpec spec = empty_case(0.0275, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {3.22, 1.0, 1.0}, {"+z"})};
  FluidTable fill;
  fill.shape = BlockShape::fill;
  fill.seed = {0.5, 0.5, 0.2};
  fill.level = 0.55;
  const FluidTable block = box_fluid({1.992, 0.0, 0.0}, {3.22, 1.0, 0.55});
  for (const auto& [table, length] : {std::pair{fill, 3.22}, {block, 1.228}}) {
    spec.fluid = {table};
    const Boundary<3> boundary = make_boundary<3>(spec);
    const FluidParticles<3> fluid = make_fluid_particles(spec, boundary);
    double volume = 0.0;
    Box<3> box;
    for (std::size_t i = 0; i < fluid.position.size(); ++i) {
      volume += fluid.volume[i];
      box.extend(fluid.position[i]);
    }
    EXPECT_NEAR(volume, length * 1.0 * 0.55, 1e-9);
    EXPECT_NEAR(box.max()[0], 3.22 - 0.5 * length / std::round(length / 0.0275), 1e-12);
    EXPECT_NEAR(box.min()[1], 0.5 / std::round(1.0 / 0.0275), 1e-12);
    EXPECT_NEAR(box.min()[2], 0.5 * 0.0275, 1e-12);
  }
}

TEST(Fill, LeavesBodiesOutAndStandsRightAtThem) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {3.0, 2.0, 2.0}, {"+z"}),
                box_wall({0.73, 0.61, 0.0}, {1.57, 1.44, 0.66}, {}, FluidSide::outside)};
  FluidTable fill;
  fill.shape = BlockShape::fill;
  fill.seed = {0.2, 0.2, 0.2};
  fill.level = 1.23;
  FluidTable block = box_fluid({0.0, 0.0, 0.0}, {3.0, 2.0, 1.23});
  for (const FluidTable& table : {fill, block}) {
    spec.fluid = {table};
    const FluidParticles<3> fluid = make_fluid_particles(spec, make_boundary<3>(spec));
    double volume = 0.0;
    for (const double v : fluid.volume) volume += v;
    EXPECT_NEAR(volume, 3.0 * 2.0 * 1.23 - 0.84 * 0.83 * 0.66, 1e-9);
    double nearest = infinite;
    for (const Vec<3>& x : fluid.position) {
      if (x[1] > 0.7 && x[1] < 1.4 && x[2] < 0.6 && x[0] < 0.73) nearest = std::min(nearest, 0.73 - x[0]);
    }
    EXPECT_NEAR(nearest, 0.5 * 0.73 / 7.0, 1e-12);
  }
}

TEST(Fill, RunsAroundCornersAndOverASheet) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.025, 3);
  // A hill through a tank: water fills both sides of it when its seed is in one and the level is above the crest.
  const TriangleMesh hill = sheet_mesh(20, [](double x, double) { return 0.4 - 1.2 * std::abs(x - 0.5) + 0.3; });
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {"+z"}), folder.wall(hill, FluidSide::above)};
  FluidTable fill;
  fill.shape = BlockShape::fill;
  fill.seed = {0.1, 0.5, 0.5};
  const auto volume_at = [&](double level) {
    fill.level = level;
    spec.fluid = {fill};
    const FluidParticles<3> fluid = make_fluid_particles(spec, make_boundary<3>(spec));
    double volume = 0.0;
    for (const double v : fluid.volume) volume += v;
    // The 40 cells of a row along the hill are alike: all of them are particles or none.
    EXPECT_NEAR(static_cast<double>(fluid.position.size()), volume / power<3>(0.025), 20.0 + 1e-6);
    return volume;
  };
  // A third of a cell that two walls cut counts as cut by the nearer: less than half of its section is wrong along the
  // lines, less than 6 m long, on which the hill meets the tank and where its two slopes meet.
  const double bound = 6.0 * 0.5 * std::pow(0.025 / 3.0, 2);
  const double slope = 0.5 * 0.5 / 1.2 * 0.5;  // of the wedge on one side, up to z = 0.6
  EXPECT_NEAR(volume_at(0.6), slope, bound);
  EXPECT_NEAR(volume_at(0.9), 0.9 - 0.4, bound);
}

// Where dx does not divide the depth, cells are taller than dx: 0.25 m of a terrain of 0.25 m for dx of 0.245 m.
TEST(Fill, StaysAboveATerrainWhateverTheSpacing) {
  const MeshFolder folder;
  TriangleMesh slope;
  for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {5.0, -1.0}, {5.0, 2.0}, {-1.0, 2.0}}) {
    slope.points.emplace_back(x, y, -0.0078125 + 0.0625 * (x + 1.0));
  }
  slope.triangles = {{0, 1, 2}, {0, 2, 3}};
  FluidTable fill;
  fill.shape = BlockShape::fill;
  fill.seed = {0.5, 0.5, 0.8};
  fill.level = 1.0;
  const double exact = 4.0 * (1.0 - (-0.0078125 + 0.0625 * 3.0));
  for (const double dx : {0.25, 0.245, 0.24, 0.2, 0.17, 0.15, 0.13}) {
    CaseSpec spec = empty_case(dx, 3);
    spec.walls = {folder.wall(slope, FluidSide::above), box_wall({0.0, 0.0, -1.0}, {4.0, 1.0, 1.5}, {"+z", "-z"})};
    spec.fluid = {fill};
    const Boundary<3> boundary = make_boundary<3>(spec);
    const FluidParticles<3> fluid = make_fluid_particles(spec, boundary);
    double volume = 0.0;
    for (const double v : fluid.volume) volume += v;
    // A third of a cell that two walls cut counts as cut by the nearer: less than half of its section is wrong along
    // the 10 m on which the terrain meets the sides.
    EXPECT_NEAR(volume, exact, 10.0 * 0.5 * std::pow(1.5 * dx / 3.0, 2)) << dx;
    for (const Vec<3>& x : fluid.position) EXPECT_GT(boundary.nearest(x, infinite).signed_distance, 0.0) << dx;
  }
}

// Beyond an edge of a basin of separate meshes a place is behind none of them by itself, and it is in front of a dam
// that crosses the basin.
TEST(Fill, EndsAtTheEdgesOfABasinOfMeshesBesideADam) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.02, 3);
  const auto add = [&](const std::vector<Vec<3>>& points, const std::vector<std::array<int, 4>>& quads,
                       FluidSide side) {
    TriangleMesh mesh;
    mesh.points = points;
    for (const auto& [a, b, c, d] : quads) add_quad(mesh, a, b, c, d);
    const std::string name = fmt::format("wall{}.stl", spec.walls.size());
    spec.walls.push_back(MeshFolder::wall_of_file(folder.write(name, ascii_stl(mesh)), side));
  };
  constexpr double length = 0.8, width = 0.4, height = 0.3, level = 0.2, beyond = 0.03, toe = 0.35;
  const auto sheet = [&](const Vec<3>& a, const Vec<3>& b, const Vec<3>& c, const Vec<3>& d) {
    add({a, b, c, d}, {{0, 1, 2, 3}}, FluidSide::front);
  };
  sheet({0.0, 0.0, 0.0}, {length, 0.0, 0.0}, {length, width, 0.0}, {0.0, width, 0.0});
  sheet({0.0, 0.0, 0.0}, {0.0, 0.0, height}, {length, 0.0, height}, {length, 0.0, 0.0});
  sheet({0.0, width, 0.0}, {length, width, 0.0}, {length, width, height}, {0.0, width, height});
  sheet({0.0, 0.0, 0.0}, {0.0, width, 0.0}, {0.0, width, height}, {0.0, 0.0, height});
  sheet({length, 0.0, 0.0}, {length, 0.0, height}, {length, width, height}, {length, width, 0.0});
  std::vector<Vec<3>> dam;  // its face leans by 45 degrees
  for (const double y : {-beyond, width + beyond}) {
    for (const auto& [x, z] : {std::pair{toe - beyond, -beyond}, {0.65, -beyond}, {0.65, 0.25}, {toe + 0.25, 0.25}}) {
      dam.emplace_back(x, y, z);
    }
  }
  add(dam, {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}, FluidSide::outside);
  FluidTable fill;
  fill.shape = BlockShape::fill;
  fill.seed = {0.1, 0.2, 0.1};
  fill.level = level;
  spec.fluid = {fill};
  const FluidParticles<3> fluid = make_fluid_particles(spec, make_boundary<3>(spec));
  double volume = 0.0;
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    const Vec<3>& x = fluid.position[i];
    EXPECT_GT(std::min({x[0], x[1], x[2], width - x[1], level - x[2]}), 0.0) << x.transpose();
    volume += fluid.volume[i];
  }
  const double exact = width * level * (toe + 0.5 * level);
  EXPECT_NEAR(volume, exact, 0.003 * exact);
}

TEST(Fill, OverASlopeHasTheVolumeOfTheWater) {
  CaseSpec spec = empty_case(0.025, 2);
  WallTable tank;
  tank.name = "tank";
  const double rise = std::tan(std::numbers::pi / 18.0);
  tank.points = {{0.0, 0.6}, {0.0, 0.0}, {0.5, 0.5 * rise}, {0.5, 0.6}};
  spec.walls = {tank};
  FluidTable fill;
  fill.shape = BlockShape::fill;
  fill.seed = {0.25, 0.27};
  fill.level = 0.3;
  spec.fluid = {fill};
  const Boundary<2> boundary = make_boundary<2>(spec);
  const FluidParticles<2> fluid = make_fluid_particles(spec, boundary);
  double volume = 0.0;
  for (const double v : fluid.volume) volume += v;
  // As above: less than half of a third of a cell is wrong in each corner.
  const double exact = 0.5 * (0.3 - 0.25 * rise);
  EXPECT_NEAR(volume, exact, std::pow(0.025 / 3.0, 2));
  EXPECT_EQ(fluid.position.size(), static_cast<std::size_t>(std::lround(exact / (0.025 * 0.025))));
  for (const Vec<2>& x : fluid.position) EXPECT_GT(boundary.nearest(x, infinite).signed_distance, 0.2499 * 0.025);
}

TEST(Fill, ThatCannotBeIsRefused) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {3.0, 2.0, 1.0}, {"+z"}),
                box_wall({1.0, 0.5, 0.0}, {2.0, 1.5, 0.6}, {}, FluidSide::outside)};
  FluidTable fill;
  fill.shape = BlockShape::fill;
  const auto refusal = [&](Coordinates seed, double level) -> std::string {
    fill.seed = std::move(seed);
    fill.level = level;
    spec.fluid = {fill};
    try {
      make_fluid_particles(spec, make_boundary<3>(spec));
    } catch (const InputError& error) {
      return error.what();
    }
    return "taken";
  };
  expect_words(refusal({1.5, 1.0, 0.4}, 0.8), {"fluid 'fluid1': seed (1.5, 1, 0.4) is in wall 'wall2', 0.2 m behind"});
  expect_words(refusal({0.5, 1.0, 0.4}, 1.2),
               {"level = 1.2 runs out of the case at", "wall 'wall1'", "lower the level"});
  expect_words(refusal({0.5, 1.0, 0.9}, 0.8), {"not below level = 0.8"});
  EXPECT_EQ(refusal({0.5, 1.0, 0.4}, 0.8), "taken");
}

}  // namespace
}  // namespace fill_test
}  // namespace tailwater
