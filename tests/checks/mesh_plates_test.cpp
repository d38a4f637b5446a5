// Plates from meshes: open sheets with water on both sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "checks/check.h"
#include "geometry/boundary.h"
#include "geometry/mesh_surface.h"
#include "geometry/meshes.h"
#include "sampling/fluid_particles.h"
#include "sampling/wall_particles.h"
#include "sampling/water_lattice.h"

namespace tailwater {
namespace {

using namespace testing_cases;

constexpr double spacing_of_sheets = 0.0625;  // which mesh files hold exactly

/// A sheet of squares of triangles over [0, 1] x [0, 1], put where place(u, v) says.
template <class Place>
WallTable sheet_plate(const MeshFolder& folder, int cells, Place&& place) {
  TriangleMesh mesh = sheet_mesh(cells, [](double, double) { return 0.0; });
  for (Vec<3>& x : mesh.points) x = place(x[0], x[1]);
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.file = folder.write("sheet.stl", binary_stl(mesh));
  return plate;
}

/// A tank of 1.5 m x 1 m x 1 m with water 0.75 m deep.
CaseSpec tank_with_plate(const WallTable& plate) {
  CaseSpec spec = empty_case(spacing_of_sheets, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {1.5, 1.0, 1.0}, {"+z"}), plate};
  spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {1.5, 1.0, 0.75})};
  return spec;
}

double visible(const Boundary<3>& boundary, const Vec<3>& from, const Vec<3>& to, int felt = felt_past_screens) {
  std::vector<int> all(boundary.screens.size());
  std::iota(all.begin(), all.end(), 0);
  const double visible = visible_fraction<3>(boundary.screens, all, from, to, felt);
  EXPECT_EQ(visible,
            visible_fraction<3>(boundary.screens, boundary.screens_near(to, (to - from).norm()), from, to, felt));
  return visible;
}

std::vector<std::array<double, 3>> places_of_wall(const CaseSpec& spec, int wall) {
  const Boundary<3> boundary = make_boundary<3>(spec);
  const WallParticles<3> walls =
      make_dummy_particles<3>(boundary, spec.particles.spacing, 3, {}, lattice_behind_meshes(spec, boundary));
  std::vector<std::array<double, 3>> places;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    // To a thousandth of the spacing, so that the order does not hang on round-off.
    const Vec<3> x =
        (walls.position[i] / (0.001 * spec.particles.spacing)).each([](double steps) { return std::round(steps); });
    if (walls.wall[i] == wall) places.push_back({x[0], x[1], x[2]});
  }
  std::ranges::sort(places);
  return places;
}

// Its foot stands on the bed, one side on the side wall, the others in the water, and all corners are right.
TEST(MeshPlate, OfARectangleIsTheRectangle) {
  const MeshFolder folder;
  const CaseSpec with_mesh =
      tank_with_plate(sheet_plate(folder, 5, [](double u, double v) { return Vec<3>(0.75, 0.625 * u, 0.5 * v); }));
  WallTable rectangle;
  rectangle.shape = WallShape::plate;
  rectangle.points = {{0.75, 0.0, 0.0}, {0.75, 0.625, 0.0}, {0.75, 0.625, 0.5}, {0.75, 0.0, 0.5}};
  const CaseSpec with_rectangle = tank_with_plate(rectangle);
  EXPECT_EQ(places_of_wall(with_mesh, 1), places_of_wall(with_rectangle, 1));
  const Boundary<3> mesh = make_boundary<3>(with_mesh);
  const Boundary<3> expected = make_boundary<3>(with_rectangle);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  const double reach = 3.0 * spacing_of_sheets;
  int hidden = 0;
  for (int k = 0; k < 10000; ++k) {
    const Vec<3> from(0.75 + 0.5 * reach * share(random), 0.3 + 0.7 * share(random), 0.25 + 0.6 * share(random));
    const Vec<3> to = from + reach / std::sqrt(3.0) * Vec<3>(share(random), share(random), share(random));
    for (const int felt : {felt_past_screens, 1}) {
      EXPECT_NEAR(visible(mesh, from, to, felt), visible(expected, from, to, felt), 1e-5)
          << from.transpose() << " " << to.transpose();
    }
    hidden += visible(mesh, from, to) < 0.5 ? 1 : 0;
  }
  EXPECT_GT(hidden, 500);
}

// A half-pipe in the middle of the water hides what passes one of its triangles, more than half of it within its rim.
TEST(MeshPlate, HidesWhatPassesItsTriangles) {
  const MeshFolder folder;
  const CaseSpec spec = tank_with_plate(sheet_plate(folder, 8, [](double u, double v) {
    const double angle = std::numbers::pi * u;
    return Vec<3>(0.75 + 0.25 * std::cos(angle), 0.32 + 0.36 * v, 0.32 + 0.25 * std::sin(angle));
  }));
  const Boundary<3> boundary = make_boundary<3>(spec);
  const MeshSurface& sheet = *boundary.plates.at(0).sheet;
  const auto of_the_sheet = std::ranges::count(boundary.screens, false, &Screen<3>::is_beyond);
  EXPECT_EQ(of_the_sheet, static_cast<std::ptrdiff_t>(sheet.mesh().triangles.size()));  // no end of it is on a wall
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  int hidden = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec<3> from(0.75 + 0.4 * share(random), 0.5 + 0.5 * share(random), 0.4 + 0.3 * share(random));
    const Vec<3> to = from + 0.1 * Vec<3>(share(random), share(random), share(random));
    const bool is_passed = sheet.first_crossed(from, to, 1e-12) >= 0;
    EXPECT_EQ(visible(boundary, from, to) < 0.5, is_passed) << from.transpose() << " to " << to.transpose();
    hidden += is_passed ? 1 : 0;
  }
  EXPECT_GT(hidden, 500);
  EXPECT_TRUE(check_geometry(spec, boundary, make_fluid_particles(spec, boundary)).empty());
}

TEST(MeshPlate, ThatCannotBeIsRefused) {
  const MeshFolder folder;
  const auto refusal = [](const CaseSpec& spec) -> std::string {
    try {
      const Boundary<3> boundary = make_boundary<3>(spec);
      const Findings findings = check_geometry(spec, boundary, make_fluid_particles(spec, boundary));
      return findings.empty() ? "taken" : findings[0].message();
    } catch (const InputError& error) {
      return error.what();
    }
  };
  WallTable closed;
  closed.shape = WallShape::plate;
  closed.file = folder.write("box.stl", binary_stl(box_mesh({0.5, 0.25, 0.25}, {1.0, 0.5, 0.5})));
  const std::string of_closed = refusal(tank_with_plate(closed));
  for (const std::string word : {"wall 'wall2': file ", "box.stl", "is a closed mesh", "shape = \"mesh\""}) {
    EXPECT_NE(of_closed.find(word), std::string::npos) << of_closed;
  }
  const WallTable fine = sheet_plate(folder, 60, [](double u, double v) { return Vec<3>(0.75, u, v); });
  EXPECT_NE(refusal(tank_with_plate(fine)).find("at most 5000; draw them coarser"), std::string::npos);
  const auto sheet = [](double u, double v) { return Vec<3>(0.75, 0.1 + 0.5 * u, 0.1 + 0.5 * v); };
  CaseSpec on_wall = tank_with_plate(sheet_plate(folder, 2, sheet));
  on_wall.scheme.formulation = Formulation::published;
  EXPECT_NE(refusal(on_wall).find("scheme.formulation = \"robust\""), std::string::npos) << refusal(on_wall);
}

}  // namespace
}  // namespace tailwater
