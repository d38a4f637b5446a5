// Walls from mesh files: formats, placement, signs of distances, and messages for bad files.
#include "geometry/meshes.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

#include "base/error.h"
#include "geometry/boundary.h"
#include "geometry/ending_boxes.h"
#include "geometry/mesh_surface.h"
#include "geometry/mesh_walls.h"
#include "geometry/wall_patches.h"

namespace tailwater {
namespace {

using namespace testing_cases;

constexpr double infinite = std::numeric_limits<double>::infinity();

TriangleMesh mesh_of(const WallTable& wall) { return make_wall_mesh(case_with(wall), wall, CaseLabel("wall", "pier")); }

std::string refusal_of(const WallTable& wall) {
  try {
    mesh_of(wall);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "the mesh was taken";
  return {};
}

TEST(MeshFile, OfEveryFormatIsTheSameWeldedMesh) {
  const MeshFolder folder;
  const TriangleMesh box = unit_box();
  for (const auto& [name, bytes] : {std::pair<std::string, std::string>{"a.stl", ascii_stl(box)},
                                    {"b.STL", binary_stl(box)},
                                    {"c.obj", obj(box)},
                                    {"d.ply", ply(box)}}) {
    const TriangleMesh mesh = mesh_of(MeshFolder::wall_of_file(folder.write(name, bytes), FluidSide::outside));
    EXPECT_EQ(mesh.triangles.size(), 12u) << name;
    EXPECT_EQ(mesh.points.size(), 8u) << name;
    EXPECT_NEAR(volume_of(mesh), 1.0, 1e-12) << name;
  }
}

TEST(MeshFile, ThatHasMoreTrianglesThanItSaysIsRefused) {
  const MeshFolder folder;
  std::string bytes = binary_stl(unit_box());
  const std::uint32_t claimed = 8;
  std::memcpy(bytes.data() + 80, &claimed, sizeof(claimed));
  const std::string message = refusal_of(MeshFolder::wall_of_file(folder.write("a.stl", bytes), FluidSide::outside));
  EXPECT_NE(message.find("holds 12 triangles, but its header says 8"), std::string::npos) << message;
}

TEST(MeshFile, ThatIsNoFileIsRefused) {
  const MeshFolder folder;
  const std::string pipe = folder.write("pipe.stl", "");
  std::filesystem::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(mesh_of(MeshFolder::wall_of_file(pipe, FluidSide::outside)), IoError);
}

TEST(WallPatches, AreCountedBeforeTheyAreMade) {
  CaseSpec spec = testing_cases::empty_case(0.1, 3);
  spec.walls = {testing_cases::box_wall({0, 0, 0}, {1.6, 2147483648.0, 1}, {"+z", "-y", "+y"})};
  spec.walls[0].name = "tank";
  const Boundary<3> boundary = make_boundary<3>(spec);
  try {
    make_wall_patches(boundary, 0.15);
    FAIL() << "the patches were made";
  } catch (const CaseError& error) {
    const std::string message = error.what();
    for (const std::string part : {"wall 'tank', which reaches from (0, 0, 0) to (1.6, 2.14748e+09, 1)",
                                   "at most 1e+08", "draw the wall no longer"}) {
      EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }
}

// The edges of a box of four times the length of a patch differ in their last digits once it has moved, and so did its
// number of patches: a force probe read beyond the end of its own ones.
TEST(WallPatches, AreAsManyWhenTheirWallHasMoved) {
  CaseSpec spec = testing_cases::empty_case(0.05, 3);
  spec.walls = {testing_cases::box_wall({0.35, 0.15, 0.1}, {0.65, 0.45, 0.4}, {}, FluidSide::outside)};
  const Boundary<3> drawn = make_boundary<3>(spec);
  const std::size_t count = make_wall_patches(drawn, 0.075).size();
  for (const double way : {0.001, 0.1, 0.37, 123.4}) {
    Boundary<3> moved = drawn;
    for (WallFace<3>& face : moved.faces) face = face.moved(Vec<3>(way, -2.0 * way, 0.3 * way));
    EXPECT_EQ(make_wall_patches(moved, 0.075).size(), count) << way;
  }
}

TEST(MeshFile, IsScaledTurnedAndMoved) {
  const MeshFolder folder;
  WallTable wall = folder.wall(box_mesh({0.0, 0.0, 0.0}, {1000.0, 200.0, 300.0}), FluidSide::inside);
  wall.scale = 0.001;
  wall.rotate = {0.0, 0.0, 90.0};  // x becomes y
  wall.translate = {5.0, 0.0, 1.0};
  const TriangleMesh mesh = mesh_of(wall);
  const MeshSurface surface(mesh);
  EXPECT_LT((surface.low() - Vec<3>(4.8, 0.0, 1.0)).norm(), 1e-6);
  EXPECT_LT((surface.high() - Vec<3>(5.0, 1.0, 1.3)).norm(), 1e-6);
  EXPECT_NEAR(volume_of(mesh), -0.06, 1e-6);  // the front faces inwards, towards the water
}

TEST(MeshFile, OfAnOpenSheetLooksToTheWater) {
  const MeshFolder folder;
  const TriangleMesh sheet = sheet_mesh(4, [](double x, double) { return 0.2 * x; });
  TriangleMesh turned = sheet;
  turn_over(turned);
  for (const TriangleMesh& drawn : {sheet, turned}) {
    EXPECT_GT(mesh_of(folder.wall(drawn, FluidSide::above)).area_normal(0)[2], 0.0);
    EXPECT_LT(mesh_of(folder.wall(drawn, FluidSide::below)).area_normal(0)[2], 0.0);
  }
  EXPECT_GT(mesh_of(folder.wall(sheet, FluidSide::front)).area_normal(0)[2], 0.0);
  EXPECT_GT(mesh_of(folder.wall(turned, FluidSide::back)).area_normal(0)[2], 0.0);
}

TEST(MeshFile, ThatIsBadIsRefusedWithPlaceAndRemedy) {
  const MeshFolder folder;
  const auto refusal = [&](const TriangleMesh& mesh, FluidSide side = FluidSide::outside) {
    return refusal_of(folder.wall(mesh, side));
  };
  TriangleMesh open = unit_box();
  open.triangles.pop_back();
  expect_words(refusal(open),
               {"wall 'pier': file ", "mesh.stl", "not watertight", "3 edges", "the edge from (1, ", "close the mesh"});
  expect_words(refusal(unit_box(), FluidSide::above), {"closed mesh", "\"inside\" or \"outside\""});

  TriangleMesh flipped = unit_box();
  std::swap(flipped.triangles[6][0], flipped.triangles[6][1]);
  expect_words(refusal(flipped), {"triangle 7", "face opposite sides", "turn one of them over"});

  TriangleMesh doubled = unit_box();
  doubled.triangles.push_back(doubled.triangles[4]);
  expect_words(refusal(doubled), {"triangle 5 at", "triangle 13 have the same corners", "remove double"});

  TriangleMesh needle = unit_box();
  needle.points.emplace_back(0.5, 0.0, 0.0);
  needle.triangles.push_back({0, 8, 1});
  expect_words(refusal(needle), {"triangle 13 at (0.5, 0, 0) has no area", "remove degenerate"});

  TriangleMesh finned = unit_box();
  finned.points.emplace_back(-1.0, -1.0, 0.5);
  finned.triangles.push_back({0, 4, 8});
  expect_words(refusal(finned), {"belongs to 3 triangles", "the edge from (0, 0, 0) to (0, 0, 1)"});

  TriangleMesh two = unit_box();
  TriangleMesh other = box_mesh({3.0, 0.0, 0.0}, {3.5, 0.5, 0.5});
  turn_over(other);
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  two.points.insert(two.points.end(), other.points.begin(), other.points.end());
  expect_words(refusal(two), {"triangle 13", "inside out"});

  expect_words(refusal(sheet_mesh(2, [](double x, double) { return x > 0.0 ? 1000.0 * x : 0.0; }), FluidSide::above),
               {"neither side", "\"front\" or \"back\""});
  expect_words(refusal(box_mesh({500000.0, 0.0, 0.0}, {500001.0, 1.0, 1.0})),
               {"500001", "move the mesh to the origin"});
}

TEST(MeshFile, ThatIsDamagedIsRefused) {
  const MeshFolder folder;
  const auto refusal = [&](const std::string& name, const std::string& bytes) {
    return refusal_of(MeshFolder::wall_of_file(folder.write(name, bytes), FluidSide::outside));
  };
  const std::string binary = binary_stl(unit_box());
  expect_words(refusal("empty.stl", ""), {"empty.stl", "is empty"});
  expect_words(refusal("cut.stl", binary.substr(0, binary.size() - 30)), {"cut.stl", "export the mesh again"});
  expect_words(refusal("noise.stl",
                       "\x7f"
                       "ELF" +
                           std::string(500, '\x01')),
               {"noise.stl", "export the mesh again"});
  expect_words(refusal("pier.step", "ISO-10303-21;"), {"\".step\" is no kind of mesh", ".stl, .obj or .ply"});
  expect_words(refusal("none.ply", ply({})), {"none.ply", "export the mesh again"});
  for (const char* format : {"ascii", "binary_little_endian"}) {  // elements without properties take no space
    const std::string endless =
        fmt::format("ply\nformat {} 1.0\nelement vertex 9000000000000000000\nend_header\n1 2 3\n", format);
    expect_words(refusal("endless.ply", endless), {"endless.ply", "9000000000000000000", "6 bytes left", "cut off"});
  }
  std::string heights = ply(unit_box());
  heights.replace(heights.find("float z"), 7, "float height");
  expect_words(refusal("heights.ply", heights), {"heights.ply", "no property \"z\"", "x, y, height", "name their"});
  std::string doubled = ply(unit_box());
  doubled.replace(doubled.find("float y"), 7, "float x");
  expect_words(refusal("doubled.ply", doubled), {"doubled.ply", "more than one property \"x\""});
  TriangleMesh broken = unit_box();
  broken.points[7][1] = std::numeric_limits<double>::quiet_NaN();
  expect_words(refusal("nan.stl", binary_stl(broken)), {"nan.stl", "triangle 3 has a corner that is not a number"});
  for (const std::string& bytes : {ascii_stl(unit_box()), binary, obj(unit_box()), ply(unit_box())}) {
    const std::string name = bytes == binary              ? "part.stl"
                             : bytes.starts_with("solid") ? "part.stl"
                             : bytes.starts_with("ply")   ? "part.ply"
                                                          : "part.obj";
    for (std::size_t part = 1; part < 8; ++part) refusal(name, bytes.substr(0, part * bytes.size() / 8));
  }
}

TEST(MeshSurface, MeasuresTheDistanceFromABoxOnAllSides) {
  const MeshSurface surface(unit_box());
  EXPECT_TRUE(surface.is_closed());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-0.6, 1.6);
  for (int k = 0; k < 2000; ++k) {
    const Vec<3> x(coordinate(random), coordinate(random), coordinate(random));
    const Vec<3> out = (x - Vec<3>::Constant(0.5)).cwiseAbs() - Vec<3>::Constant(0.5);
    const double exact = out.cwiseMax(0.0).norm() + std::min(0.0, out.maxCoeff());
    EXPECT_NEAR(surface.nearest(x, infinite).signed_distance, exact, 1e-12) << x.transpose();
  }
}

/// A point of a body where ridges and valleys meet. Beside it, the nearest triangle may give the wrong sign.
TriangleMesh saddle_body() {
  // A disc of six directions that alternate between steeply up and steeply down, closed by a plate far below.
  TriangleMesh mesh;
  mesh.points.push_back(Vec<3>::Zero());
  for (int k = 0; k < 6; ++k) {
    const double angle = std::numbers::pi * k / 3.0;
    mesh.points.emplace_back(std::cos(angle), std::sin(angle), k % 2 == 0 ? 2.0 : -2.0);
  }
  for (int k = 0; k < 6; ++k) mesh.points.emplace_back(mesh.points[1 + k][0], mesh.points[1 + k][1], -5.0);
  mesh.points.emplace_back(0.0, 0.0, -5.0);
  for (int k = 0; k < 6; ++k) {
    const int a = 1 + k;
    const int b = 1 + (k + 1) % 6;
    mesh.triangles.push_back({0, a, b});
    add_quad(mesh, b, a, a + 6, b + 6);
    mesh.triangles.push_back({13, b + 6, a + 6});
  }
  return mesh;
}

/// Whether a point is in a closed mesh, by the solid angle of the triangles as seen from it (van Oosterom & Strackee
/// 1983). The method is independent of nearest points.
bool sees_inside(const TriangleMesh& mesh, const Vec<3>& x) {
  double angle = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Vec<3> a = mesh.corner(t, 0) - x;
    const Vec<3> b = mesh.corner(t, 1) - x;
    const Vec<3> c = mesh.corner(t, 2) - x;
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle > 2.0 * std::numbers::pi;
}

TEST(MeshSurface, HasTheRightSignAroundASaddle) {
  const TriangleMesh mesh = saddle_body();
  const MeshSurface surface(mesh);
  // The sign of the first of the nearest triangles, which is wrong at edges and corners.
  const auto naive_sign_is_behind = [&](const Vec<3>& x) {
    double least = infinite;
    bool is_behind = false;
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
      const Vec<3> foot = closest_feature(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), x).point;
      if ((x - foot).norm() >= least) continue;
      least = (x - foot).norm();
      is_behind = mesh.area_normal(t).dot(x - foot) < 0.0;
    }
    return is_behind;
  };
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  int naive_errors = 0;
  for (int k = 0; k < 20000; ++k) {
    const Vec<3> x = 0.3 * Vec<3>(coordinate(random), coordinate(random), coordinate(random));
    const SurfacePlace place = surface.nearest(x, infinite);
    ASSERT_EQ(place.signed_distance < 0.0, sees_inside(mesh, x)) << x.transpose();
    EXPECT_NEAR(std::abs(place.signed_distance), (x - place.point).norm(), 1e-12);
    naive_errors += naive_sign_is_behind(x) != (place.signed_distance < 0.0) ? 1 : 0;
  }
  EXPECT_GT(naive_errors, 0) << "the saddle does not tell the two signs apart";
}

TEST(MeshSurface, FindsTheTriangleThatAPathCrosses) {
  const MeshSurface surface(sphere_mesh(Vec<3>::Zero(), 1.0, 20));
  const int hit = surface.first_crossed({-3.0, 0.1, 0.2}, {3.0, 0.1, 0.2}, 1e-9);
  ASSERT_GE(hit, 0);
  EXPECT_LT(surface.mesh().corner(hit, 0)[0], 0.0);  // the nearer side
  EXPECT_EQ(surface.first_crossed({-3.0, 1.1, 0.0}, {3.0, 1.1, 0.0}, 1e-9), -1);
  EXPECT_EQ(surface.first_crossed({-3.0, 0.1, 0.2}, {-1.5, 0.1, 0.2}, 1e-9), -1);
}

TEST(MeshSurface, MayBeASingleTriangle) {
  TriangleMesh mesh;
  mesh.points = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  mesh.triangles = {{0, 1, 2}};
  const MeshSurface surface(mesh);
  EXPECT_NEAR(surface.nearest({0.2, 0.2, 0.3}, infinite).signed_distance, 0.3, 1e-12);
  EXPECT_NEAR(surface.nearest({0.2, 0.2, -0.3}, infinite).signed_distance, -0.3, 1e-12);
  EXPECT_EQ(surface.nearest({0.2, 0.2, 0.3}, 0.2).triangle, -1);
  EXPECT_EQ(surface.first_crossed({0.2, 0.2, 1.0}, {0.2, 0.2, -1.0}, 1e-9), 0);
  EXPECT_EQ(surface.first_crossed({0.8, 0.8, 1.0}, {0.8, 0.8, -1.0}, 1e-9), -1);
  const auto is_met = [&](const Vec<3>& low, const Vec<3>& high) {
    int met = 0;
    surface.visit_in(low, high, [&](int) { ++met; });
    return met == 1;
  };
  EXPECT_TRUE(is_met({0.1, 0.1, -0.1}, {0.2, 0.2, 0.1}));
  EXPECT_FALSE(is_met({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}));
}

TEST(MeshWall, ThatMovesIsFoundWhereItIs) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {folder.wall(unit_box(), FluidSide::outside)};
  spec.walls[0].displacement = {"t", 0.0, 0.0};
  Boundary<3> boundary = make_boundary<3>(spec);
  boundary.file_faces(0.3);
  for (WallFace<3>& face : boundary.faces) {
    for (Vec<3>& corner : face.corners) corner[0] += 2.0;
  }
  EXPECT_NEAR(boundary.nearest({1.9, 0.5, 0.5}, 0.3).signed_distance, 0.1, 1e-12);
  EXPECT_NEAR(boundary.nearest({2.1, 0.5, 0.5}, 0.3).signed_distance, -0.1, 1e-12);
  EXPECT_LT(boundary.nearest({0.5, 0.5, 0.5}, 0.3).face, 0);
}

TEST(MeshWall, TouchingABoxIsBehindEither) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({-1.0, -1.0, 0.0}, {2.0, 2.0, 2.0}, {"+z"}), folder.wall(unit_box(), FluidSide::outside)};
  const Boundary<3> boundary = make_boundary<3>(spec);
  EXPECT_NEAR(boundary.nearest({-0.05, 0.5, -0.2}, infinite).signed_distance, -0.2, 1e-12);  // below both
  EXPECT_NEAR(boundary.nearest({-0.1, 0.5, 0.3}, infinite).signed_distance, 0.1, 1e-12);
  EXPECT_NEAR(boundary.nearest({0.1, 0.5, 0.6}, infinite).signed_distance, -0.1, 1e-12);
}

TEST(MeshWall, HasNothingBehindItBeyondARimAtWhichAPlateEnds) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  TriangleMesh upright = sheet_mesh(4, [](double, double) { return 0.0; });
  for (Vec<3>& point : upright.points) point = {1.0, point[1], point[0]};
  WallTable plate;
  plate.shape = WallShape::plate;
  plate.file = folder.write("plate.stl", binary_stl(upright));
  spec.walls = {folder.wall(sheet_mesh(4, [](double, double) { return 0.0; }), FluidSide::above), plate};
  const Boundary<3> boundary = make_boundary<3>(spec);
  EXPECT_NEAR(boundary.nearest({1.03, 0.5, -0.04}, infinite).signed_distance, 0.05, 1e-12);
  EXPECT_NEAR(boundary.nearest({0.7, 0.5, -0.04}, infinite).signed_distance, -0.04, 1e-12);
}

/// Still water over a slope of 2 in a box through which the slope passes: a place behind the box is behind, whichever
/// of the two walls is nearer, and so is a place behind the slope.
TEST(MeshWall, ThatCrossesABoxHasNoWaterBehindTheBox) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.06, 3);
  TriangleMesh slope = sheet_mesh(3, [](double x, double) { return 2.0 * x; });
  for (Vec<3>& point : slope.points) point = {2.4 * point[0] - 1.5, 2.0 * point[1] - 1.0, 2.4 * point[2] - 3.0};
  spec.walls = {folder.wall(slope, FluidSide::above), box_wall({-0.6, 0.0, -1.7}, {0.3, 0.4, 0.4}, {"+z"})};
  Boundary<3> boundary = make_boundary<3>(spec);
  for (const bool are_filed : {false, true}) {
    if (are_filed) boundary.file_faces(0.3);
    for (int i = -5; i <= 5; ++i) {
      for (int k = -5; k <= 5; ++k) {
        const Vec<3> x(-0.6 + 0.021 * i, 0.2, -1.2 + 0.027 * k);
        const double above_slope = (x[2] - 2.0 * x[0]) / std::sqrt(5.0);
        const double inside_box = x[0] + 0.6;
        const bool is_water = above_slope > 0.0 && inside_box > 0.0;
        if (std::min(std::abs(above_slope), std::abs(inside_box)) < 1e-6) continue;
        EXPECT_EQ(boundary.nearest(x, 0.3).signed_distance > 0.0, is_water) << x.transpose();
      }
    }
  }
}

/// The slopes of a dyke meet at its crest and do not cross: a place beside one slope is not behind the other one.
TEST(MeshWall, ThatMeetsAnotherAtACrestDoesNotCrossIt) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  const auto slope = [](double side) {
    TriangleMesh mesh = sheet_mesh(2, [](double x, double) { return -2.0 * x; });
    for (Vec<3>& point : mesh.points) point[0] *= side;
    if (side < 0.0) {
      for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    }
    return mesh;
  };
  spec.walls = {MeshFolder::wall_of_file(folder.write("right.stl", binary_stl(slope(1.0))), FluidSide::above),
                MeshFolder::wall_of_file(folder.write("left.stl", binary_stl(slope(-1.0))), FluidSide::above)};
  const Boundary<3> boundary = make_boundary<3>(spec);
  for (const double side : {1.0, -1.0}) {
    EXPECT_GT(boundary.nearest({side * 0.1, 0.5, -0.15}, 0.3).signed_distance, 0.0);
    EXPECT_LT(boundary.nearest({side * 0.1, 0.5, -0.25}, 0.3).signed_distance, 0.0);
  }
}

/// A box becomes a mesh only where water can pass over an edge of it: not over the top of a tank, nor where a duct
/// continues its walls, even if the duct is lower than they are.
TEST(EndingBox, BecomesAMeshWhereItEndsBesideItsTop) {
  const auto becomes_mesh = [](std::vector<std::string> open, bool has_outlet, Beyond beyond) {
    CaseSpec spec = empty_case(0.1, 3);
    spec.walls = {box_wall({0.0, 0.0, 0.0}, {2.0, 1.0, 2.0}, std::move(open))};
    if (has_outlet) {
      spec.outlets = {outlet({2.0, 0.0, 0.0}, {2.0, 1.0, 0.5})};
      spec.outlets[0].beyond = beyond;
    }
    Boundary<3> boundary = make_boundary<3>(spec);
    const std::size_t screens = boundary.screens.size();
    make_meshes_of_ending_boxes(spec, boundary);
    EXPECT_EQ(boundary.screens.size() > screens, !boundary.meshes.empty());
    if (boundary.meshes.empty()) return false;
    EXPECT_GT(boundary.nearest({2.05, 0.5, -0.05}, 1.0).signed_distance, 0.0) << "beyond the end nothing is behind";
    EXPECT_LT(boundary.nearest({1.95, 0.5, -0.05}, 1.0).signed_distance, 0.0);
    return true;
  };
  EXPECT_FALSE(becomes_mesh({"+z"}, false, Beyond::channel));
  EXPECT_FALSE(becomes_mesh({"+z", "+x"}, true, Beyond::channel));
  EXPECT_TRUE(becomes_mesh({"+z", "+x"}, true, Beyond::air));
  EXPECT_TRUE(becomes_mesh({"+z", "+x"}, false, Beyond::air));
}

}  // namespace
}  // namespace tailwater
