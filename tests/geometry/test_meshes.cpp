// Walls from mesh files: formats, placement, signs of distances, what is refused and with which words, and the
// particles behind them.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <random>

#include "base/error.h"
#include "geometry/boundary.h"
#include "geometry/check.h"
#include "geometry/checks/checks.h"
#include "geometry/mesh_surface.h"
#include "geometry/mesh_walls.h"
#include "geometry/sampling.h"
#include "geometry/wall_particles.h"
#include "meshes.h"

namespace tailwater {
namespace {

using namespace testing_cases;

constexpr double infinite = std::numeric_limits<double>::infinity();

TriangleMesh unit_box() { return box_mesh(Vec<3>::Zero(), Vec<3>::Ones()); }

double volume_of(const TriangleMesh& mesh) {
  return six_volumes(mesh, [](int) { return true; }) / 6.0;
}

CaseSpec case_with(const WallTable& wall) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {wall};
  spec.fluid = {box_fluid({-1.0, -1.0, -1.0}, {2.0, 2.0, 2.0})};
  return spec;
}

TriangleMesh mesh_of(const WallTable& wall) { return make_wall_mesh(case_with(wall), wall, "wall 'pier'"); }

std::string refusal_of(const WallTable& wall) {
  try {
    mesh_of(wall);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "the mesh was taken";
  return {};
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
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
  EXPECT_NEAR(volume_of(mesh), -0.06, 1e-6);  // its front looks inwards, at the water
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
  for (const char* format : {"ascii", "binary_little_endian"}) {  // without properties elements take no room
    const std::string endless =
        fmt::format("ply\nformat {} 1.0\nelement vertex 9000000000000000000\nend_header\n1 2 3\n", format);
    expect_words(refusal("endless.ply", endless), {"endless.ply", "9000000000000000000", "6 bytes left", "cut off"});
  }
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
    const Vec<3> out = (x.array() - 0.5).abs().matrix() - Vec<3>::Constant(0.5);
    const double exact = out.cwiseMax(0.0).norm() + std::min(0.0, out.maxCoeff());
    EXPECT_NEAR(surface.nearest(x, infinite).signed_distance, exact, 1e-12) << x.transpose();
  }
}

/// A point of a body where ridges and valleys meet. Beside it, a nearest triangle may show the wrong sign.
TriangleMesh saddle_body() {
  // A disc of six directions that go steeply up and down in turn, closed by a plate far below.
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

/// Whether a point is in a closed mesh, by the solid angle under which it sees the triangles (van Oosterom & Strackee
/// 1983), which knows nothing of nearest points.
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

TEST(MeshWall, OfABoxHasTheWallParticlesOfABox) {
  const MeshFolder folder;
  for (const FluidSide side : {FluidSide::inside, FluidSide::outside}) {
    CaseSpec spec = empty_case(0.1, 3);
    spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {1.0, 1.0, 0.5})};
    spec.walls = {box_wall({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {}, side)};
    const WallParticles<3> box = make_dummy_particles(make_boundary<3>(spec), 0.1, 3);
    spec.walls = {folder.wall(unit_box(), side)};
    const WallParticles<3> mesh = make_dummy_particles(make_boundary<3>(spec), 0.1, 3);
    // Beyond an edge of the tank the mesh leaves out what is farther from the wall than the layers are deep.
    std::size_t shared = 0;
    PointGrid<3> places(1e-6);
    std::vector<int> rows;
    for (std::size_t i = 0; i < box.size(); ++i) places.add(box.position[i]);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      int same = -1;
      places.visit_near(mesh.position[i], [&](int k) { same = k; });
      ASSERT_GE(same, 0) << mesh.position[i].transpose();
      ++shared;
      if (side == FluidSide::outside) continue;  // in a body's edges, which wall is nearest is a tie
      EXPECT_LT((mesh.normal[i] - box.normal[same]).norm(), 1e-6) << mesh.position[i].transpose();
      EXPECT_LT((mesh.blocked[i] - box.blocked[same]).norm(), 1e-6) << mesh.position[i].transpose();
    }
    const double least = side == FluidSide::outside ? 1.0 : 0.9;
    EXPECT_GE(static_cast<double>(shared), least * static_cast<double>(box.size()));
  }
}

// Of two spheres that overlap, whose particles compete for cells.
TEST(MeshWall, HasTheSameParticlesInShares) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0})};
  spec.walls = {folder.wall(sphere_mesh({0.03, 0.02, 0.01}, 0.55, 16), FluidSide::outside),
                folder.wall(sphere_mesh({0.33, 0.22, 0.11}, 0.45, 16), FluidSide::outside)};
  const Boundary<3> boundary = make_boundary<3>(spec);
  const WallParticles<3> all = make_dummy_particles(boundary, 0.1, 3);
  std::map<std::int64_t, std::size_t> row_of_number;
  for (std::size_t row = 0; row < all.size(); ++row) row_of_number[all.number[row]] = row;
  ASSERT_EQ(row_of_number.size(), all.size());
  std::size_t made = 0;
  for (int share = 0; share < 3; ++share) {
    const WallParticles<3> part = make_dummy_particles(boundary, 0.1, 3, {.edge = 0.8, .share = share, .shares = 3});
    EXPECT_LT(part.size(), all.size() * 3 / 4) << "no share has most";
    made += part.size();
    for (std::size_t k = 0; k < part.size(); ++k) {
      ASSERT_TRUE(row_of_number.contains(part.number[k])) << part.position[k].transpose();
      const std::size_t row = row_of_number[part.number[k]];
      EXPECT_EQ(part.position[k], all.position[row]);
      EXPECT_EQ(part.share[k], all.share[row]);
      EXPECT_EQ(part.wall[k], all.wall[row]);
    }
  }
  EXPECT_EQ(made, all.size());
}

TEST(MeshWall, FillsTheSpaceBehindIt) {
  // A sphere in water.
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0})};
  spec.walls = {folder.wall(sphere_mesh({0.03, 0.02, 0.01}, 0.55, 24), FluidSide::outside)};
  const Boundary<3> boundary = make_boundary<3>(spec);
  const FluidParticles<3> fluid = make_fluid_particles(spec, boundary);
  const WallParticles<3> walls = make_dummy_particles(boundary, 0.1, 3);
  const Vec<3> centre(0.03, 0.02, 0.01);
  double volume = 0.0;
  double moment = 0.0;  // of inertia, of all parts as points
  const auto add = [&](const Vec<3>& x, double part) {
    volume += part;
    moment += part * (x - centre).squaredNorm();
  };
  for (std::size_t i = 0; i < walls.size(); ++i) add(walls.position[i], walls.share[i] * 1e-3);
  for (int n = 0; n < 8000; ++n) {
    const Vec<3> x = Vec<3>(n % 20, n / 20 % 20, n / 400) * 0.1 - Vec<3>::Constant(0.95);
    if (boundary.nearest(x, infinite).signed_distance < -0.3) add(x, 1e-3);  // deeper in the sphere than the layers
  }
  // A third of a cell, p wide, is cut by a plane, and the sphere falls away from a plane by p^2/(6 R) in the mean.
  const double exact = volume_of(sphere_mesh(centre, 0.55, 24));
  const double bound = 4.0 * std::numbers::pi * 0.55 * 0.55 * 0.1 * 0.1 / (9.0 * 6.0 * 0.55);
  EXPECT_NEAR(volume, exact, bound);
  // A point has none of the moment of its cell, dx^2/4 times its volume.
  const double moment_of_sphere = 0.6 * 0.55 * 0.55 * exact;
  EXPECT_GT(moment, moment_of_sphere - 0.1 * 0.1 / 4.0 * exact - 0.55 * 0.55 * bound);
  EXPECT_LT(moment, moment_of_sphere + 0.55 * 0.55 * bound);
  // The share of the lattice that is not water is the sphere's, to the noise of counting nodes on its surface.
  EXPECT_NEAR((8000.0 - static_cast<double>(fluid.position.size())) * 1e-3, exact, 0.02 * exact);
  for (const Vec<3>& x : fluid.position) EXPECT_GT(boundary.nearest(x, infinite).signed_distance, 0.0249);
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

TEST(CheckMeshes, FindsWrongUnitsCrossingsAndPlates) {
  const MeshFolder folder;
  const auto errors = [&](const TriangleMesh& mesh, double scale = 1.0) {
    CaseSpec spec = case_with(folder.wall(mesh, FluidSide::outside));
    spec.walls[0].scale = scale;
    const Boundary<3> boundary = make_boundary<3>(spec);
    std::string text;
    for (const Finding& finding : check_meshes(spec, boundary, make_fluid_particles(spec, boundary))) {
      text += finding.message + "\n";
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

// A tank of 3 m with a body in it, beside it, or so large that the tank is inside.
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
  expect_words(findings[0].message, {"wall 'wall1': file ", "mesh.stl reaches from (5, 0, 0) to (6, 1, 1)",
                                     "from (-1, -1, -1) to (2, 2, 2), so it stands beside them", "correct translate"});
  spec.walls[0].translate = {-4.0, -4.0, 0.0};
  spec.walls[0].scale = 8.0;
  findings = found();
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  expect_words(findings[0].message, {"is a body 8 m long among water and walls of 3 m", "0.001 for a file in mill"});
}

TEST(CheckMeshes, AWayThatCutsThroughABodyIsNotBehindIt) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0.0, 0.0, 0.0}, {1.6, 1.6, 2.0}, {"+z"}),
                folder.wall(sphere_mesh({0.831, 0.812, 0.822}, 0.5, 48), FluidSide::outside)};
  spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {1.6, 1.6, 1.6})};
  const Boundary<3> boundary = make_boundary<3>(spec);
  for (const Finding& finding : check_geometry(spec, boundary, make_fluid_particles(spec, boundary))) {
    EXPECT_EQ(finding.severity, Severity::warning) << finding.message;
  }
}

TEST(MeshWall, HoldsWaterOffAtItsEdgesAsFarAsAtItsFaces) {
  const MeshFolder folder;
  for (const double tilt : {0.2, 0.5, 0.8, 1.1}) {
    TriangleMesh cube = box_mesh(Vec<3>::Constant(-0.5), Vec<3>::Constant(0.5));
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(0.6 * tilt, Vec<3>::UnitX()) * Eigen::AngleAxisd(tilt, Vec<3>::UnitZ())).toRotationMatrix();
    for (Vec<3>& x : cube.points) x = turn * x + Vec<3>(0.53, 0.51, 0.52);
    CaseSpec spec = case_with(folder.wall(cube, FluidSide::outside));
    const Boundary<3> boundary = make_boundary<3>(spec);
    double nearest = infinite;
    for (const Vec<3>& x : make_fluid_particles(spec, boundary).position) {
      nearest = std::min(nearest, boundary.nearest(x, infinite).signed_distance);
    }
    EXPECT_GE(nearest, (0.25 - 1e-6) * spec.particles.spacing) << "tilt " << tilt;
  }
}

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
    Eigen::AlignedBox<double, 3> box;
    for (std::size_t i = 0; i < fluid.position.size(); ++i) {
      volume += fluid.volume[i];
      box.extend(fluid.position[i]);
    }
    EXPECT_NEAR(volume, length * 1.0 * 0.55, 1e-9);
    EXPECT_NEAR(box.max()[0], 3.22 - 0.5 * length / std::round(length / 0.0275), 1e-12);
    EXPECT_NEAR(box.min()[1], 0.5 / std::round(1.0 / 0.0275), 1e-12);
    EXPECT_NEAR(box.min()[2], 0.5 * 0.0275, 1e-12);
    for (const Finding& finding : check_geometry(spec, boundary, fluid)) ADD_FAILURE() << finding.message;
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
}  // namespace tailwater
