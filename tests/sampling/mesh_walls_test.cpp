// Particles behind walls from meshes, and the water in front of them.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "geometry/boundary.h"
#include "geometry/meshes.h"
#include "geometry/point_grid.h"
#include "geometry/rotation.h"
#include "sampling/fluid_particles.h"
#include "sampling/wall_particles.h"
#include "sampling/water_lattice.h"

namespace tailwater {
namespace {

using namespace testing_cases;

constexpr double infinite = std::numeric_limits<double>::infinity();

WallParticles<3> walls_of(const CaseSpec& spec, const SpaceShare& share = {}) {
  const Boundary<3> boundary = make_boundary<3>(spec);
  return make_dummy_particles<3>(boundary, spec.particles.spacing, 3, share, lattice_behind_meshes(spec, boundary));
}

TEST(MeshWall, OfABoxHasTheWallParticlesOfABox) {
  const MeshFolder folder;
  for (const FluidSide side : {FluidSide::inside, FluidSide::outside}) {
    CaseSpec spec = empty_case(0.1, 3);
    spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {1.0, 1.0, 0.5})};
    spec.walls = {box_wall({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {}, side)};
    const WallParticles<3> box = walls_of(spec);
    spec.walls = {folder.wall(unit_box(), side)};
    const WallParticles<3> mesh = walls_of(spec);
    // Beyond an edge of the tank the mesh omits particles that are farther from the wall than the depth of the layers.
    std::size_t shared = 0;
    PointGrid<3> places(1e-6);
    std::vector<int> rows;
    for (std::size_t i = 0; i < box.size(); ++i) places.add(box.position[i]);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      int same = -1;
      places.visit_near(mesh.position[i], [&](int k) { same = k; });
      ASSERT_GE(same, 0) << mesh.position[i].transpose();
      ++shared;
      if (side == FluidSide::outside) continue;  // at the edges of a body, several walls are equally near
      EXPECT_LT((mesh.normal[i] - box.normal[same]).norm(), 1e-6) << mesh.position[i].transpose();
      EXPECT_LT((mesh.blocked[i] - box.blocked[same]).norm(), 1e-6) << mesh.position[i].transpose();
    }
    const double least = side == FluidSide::outside ? 1.0 : 0.9;
    EXPECT_GE(static_cast<double>(shared), least * static_cast<double>(box.size()));
  }
}

// One bed drawn from a crest and from a trough: a wall goes on in the next period.
TEST(MeshWall, DoesNotDependOnWhereAPeriodBegins) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.domain.periodic_x = {0.0, 2.4};
  spec.domain.periodic_y = {0.0, 1.2};
  spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {2.4, 1.2, 0.6})};
  const auto bed_through = [&](const std::vector<double>& levels) {
    TriangleMesh bed;
    for (int k = 0; k < 5; ++k) {
      for (const double y : {0.0, 1.2}) bed.points.emplace_back(0.6 * k, y, levels[k]);
      if (k > 0) add_quad(bed, 2 * k - 2, 2 * k, 2 * k + 1, 2 * k - 1);
    }
    spec.walls = {folder.wall(bed, FluidSide::above)};
    return walls_of(spec);
  };
  const WallParticles<3> from_trough = bed_through({0.0, 0.3, 0.0, 0.2, 0.0});
  const WallParticles<3> from_crest = bed_through({0.3, 0.0, 0.2, 0.0, 0.3});
  ASSERT_EQ(from_crest.size(), from_trough.size());
  PointGrid<3> places(0.1 * spec.particles.spacing);  // cells are cut alike on both sides of a crest to some per cent
  const auto in_period = [](const Vec<3>& x) {
    return Vec<3>(x[0] - 2.4 * std::floor(x[0] / 2.4), x[1] - 1.2 * std::floor(x[1] / 1.2), x[2]);
  };
  for (const Vec<3>& x : from_trough.position) places.add(in_period(x));
  for (std::size_t i = 0; i < from_crest.size(); ++i) {
    int same = -1;
    places.visit_near(in_period(from_crest.position[i] + Vec<3>(0.6, 0.0, 0.0)), [&](int k) { same = k; });
    ASSERT_GE(same, 0) << from_crest.position[i].transpose();
    EXPECT_NEAR(from_crest.share[i], from_trough.share[same], 0.04) << from_crest.position[i].transpose();
  }
}

// Two overlapping spheres, whose particles compete for cells.
TEST(MeshWall, HasTheSameParticlesInShares) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0})};
  spec.walls = {folder.wall(sphere_mesh({0.03, 0.02, 0.01}, 0.55, 16), FluidSide::outside),
                folder.wall(sphere_mesh({0.33, 0.22, 0.11}, 0.45, 16), FluidSide::outside)};
  const WallParticles<3> all = walls_of(spec);
  std::map<std::int64_t, std::size_t> row_of_number;
  for (std::size_t row = 0; row < all.size(); ++row) row_of_number[all.number[row]] = row;
  ASSERT_EQ(row_of_number.size(), all.size());
  std::size_t made = 0;
  for (int share = 0; share < 3; ++share) {
    const WallParticles<3> part = walls_of(spec, {.edge = 0.8, .share = share, .shares = 3});
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

TEST(MeshWall, HasTheParticlesOfTheFinerSpacingInAZone) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0})};
  spec.walls = {folder.wall(sphere_mesh({0.03, 0.02, 0.01}, 0.55, 16), FluidSide::outside)};
  RefinementTable zone;
  zone.min = {-9.0, -9.0, -9.0};
  zone.max = {9.0, 9.0, 9.0};
  spec.refinement = {zone};
  const Boundary<3> boundary = make_boundary<3>(spec);
  WallParticles<3> divided = walls_of(spec);
  divide_wall_particles<3>(SpacingField<3>(spec, boundary), boundary, 0.1, 3, {}, lattice_behind_meshes(spec, boundary),
                           divided);
  PointGrid<3> places(1e-6);
  for (const Vec<3>& x : divided.position) places.add(x);
  spec.particles.spacing = 0.05;
  const WallParticles<3> fine = walls_of(spec);
  EXPECT_GT(fine.size(), 1000);
  for (std::size_t row = 0; row < fine.size(); ++row) {
    int same = -1;
    places.visit_near(fine.position[row], [&](int k) { same = k; });
    ASSERT_GE(same, 0) << fine.position[row].transpose();
    EXPECT_NEAR(divided.share[same], fine.share[row] / 8.0, 1e-9);
    EXPECT_LT((divided.normal[same] - fine.normal[row]).norm(), 1e-9);
  }
  EXPECT_EQ(std::set<std::int64_t>(divided.number.begin(), divided.number.end()).size(), divided.size());
}

TEST(MeshWall, FillsTheSpaceBehindIt) {
  // A sphere in water.
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0})};
  spec.walls = {folder.wall(sphere_mesh({0.03, 0.02, 0.01}, 0.55, 24), FluidSide::outside)};
  const Boundary<3> boundary = make_boundary<3>(spec);
  const FluidParticles<3> fluid = make_fluid_particles(spec, boundary);
  const WallParticles<3> walls = walls_of(spec);
  const Vec<3> centre(0.03, 0.02, 0.01);
  double volume = 0.0;
  double moment = 0.0;  // moment of inertia of all parts as points
  const auto add = [&](const Vec<3>& x, double part) {
    volume += part;
    moment += part * (x - centre).squaredNorm();
  };
  for (std::size_t i = 0; i < walls.size(); ++i) add(walls.position[i], walls.share[i] * 1e-3);
  for (int n = 0; n < 8000; ++n) {
    const Vec<3> x = Vec<3>(n % 20, n / 20 % 20, n / 400) * 0.1 - Vec<3>::Constant(0.95);
    if (boundary.nearest(x, infinite).signed_distance < -0.3) add(x, 1e-3);  // deeper in the sphere than the layers
  }
  // A third of a cell of width p is cut by a plane, and the sphere deviates from a plane by p^2/(6 R) on average.
  const double exact = volume_of(sphere_mesh(centre, 0.55, 24));
  const double bound = 4.0 * std::numbers::pi * 0.55 * 0.55 * 0.1 * 0.1 / (9.0 * 6.0 * 0.55);
  EXPECT_NEAR(volume, exact, bound);
  // A point lacks the moment of its own cell, dx^2/4 times its volume.
  const double moment_of_sphere = 0.6 * 0.55 * 0.55 * exact;
  EXPECT_GT(moment, moment_of_sphere - 0.1 * 0.1 / 4.0 * exact - 0.55 * 0.55 * bound);
  EXPECT_LT(moment, moment_of_sphere + 0.55 * 0.55 * bound);
  // The fraction of the lattice that is not water is that of the sphere, up to the noise of counting nodes on its
  // surface.
  EXPECT_NEAR((8000.0 - static_cast<double>(fluid.position.size())) * 1e-3, exact, 0.02 * exact);
  for (const Vec<3>& x : fluid.position) EXPECT_GT(boundary.nearest(x, infinite).signed_distance, 0.0249);
}

TEST(MeshWall, HoldsWaterOffAtItsEdgesAsFarAsAtItsFaces) {
  const MeshFolder folder;
  for (const double tilt : {0.2, 0.5, 0.8, 1.1}) {
    TriangleMesh cube = box_mesh(Vec<3>::Constant(-0.5), Vec<3>::Constant(0.5));
    const Mat<3> turn = rotation_about(Vec<3>::UnitX(), 0.6 * tilt) * rotation_about(Vec<3>::UnitZ(), tilt);
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

/// A slope of 2 continues beyond the box around it. All the space behind their foot has dummies, as far as the water of
/// the foot reaches, at any angle: no sector is left out because the nearest point of its wall is behind the other one.
TEST(MeshWall, ThatCrossesABoxLeavesNoGapBehindTheirFoot) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  TriangleMesh slope = sheet_mesh(3, [](double x, double) { return -2.0 * x; });
  for (Vec<3>& point : slope.points) point = {2.4 * point[0] - 0.9, 1.2 * point[1] - 0.4, 2.4 * point[2] + 1.8};
  spec.walls = {folder.wall(slope, FluidSide::above), box_wall({-0.3, 0.0, -1.7}, {0.6, 0.4, 0.4}, {"+z"})};
  spec.fluid = {box_fluid({-0.3, 0.0, -1.2}, {0.6, 0.4, 0.0})};
  const WallParticles<3> walls = walls_of(spec);
  const double dx = spec.particles.spacing;
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vec<3> x(0.6 + 2.5 * dx * std::cos(angle), 0.2, -1.2 + 2.5 * dx * std::sin(angle));
    if (x[0] < 0.6 + 0.5 * dx && x[2] + 2.0 * x[0] > -0.5 * dx) continue;  // in the water or beside it
    double nearest = infinite;
    for (const Vec<3>& place : walls.position) nearest = std::min(nearest, (place - x).norm());
    EXPECT_LT(nearest, dx) << degrees;
  }
}

}  // namespace
}  // namespace tailwater
