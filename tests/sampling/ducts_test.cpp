// The ducts outside of openings: where their walls stand, and that they go on with those of the case.
#include "geometry/ducts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "geometry/cases.h"
#include "geometry/meshes.h"
#include "geometry/point_grid.h"
#include "geometry/wall_label.h"
#include "sampling/duct_water.h"
#include "sampling/wall_particles.h"
#include "sampling/water_lattice.h"

namespace tailwater {
namespace {

using namespace testing_cases;

constexpr double length = 4.0;  // dx, of a duct to which walls lead straight: a support of 3, and 1

template <int Dim>
Boundary<Dim> with_ducts(const CaseSpec& spec) {
  Boundary<Dim> boundary = make_boundary<Dim>(spec);
  append_ducts(spec, boundary);
  return boundary;
}

template <int Dim>
std::vector<WallFace<Dim>> duct_faces(const Boundary<Dim>& boundary) {
  std::vector<WallFace<Dim>> faces;
  for (const WallFace<Dim>& face : boundary.faces) {
    if (boundary.walls[face.wall].is_duct) faces.push_back(face);
  }
  return faces;
}

TEST(Ducts, GoOnWithTheBedOfAChannel) {
  const Boundary<2> boundary = with_ducts<2>(open_channel());
  const std::vector<WallFace<2>> faces = duct_faces(boundary);
  ASSERT_EQ(faces.size(), 1u) << "the top of the opening is open";
  EXPECT_LT((faces[0].corners[0] - Vec<2>(2.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((faces[0].corners[1] - Vec<2>(2.0 + length * 0.1, 0.0)).norm(), 1e-12);
  EXPECT_LT((faces[0].normal - Vec<2>(0.0, 1.0)).norm(), 1e-12);
  const WallProperties& wall = boundary.walls[faces[0].wall];
  EXPECT_EQ(wall.friction, 0.0);
  EXPECT_EQ(wall_label(boundary, faces[0].wall).text(), "outlet 'outlet1'");
  EXPECT_TRUE(boundary.is_in_duct({2.3, 0.3}));
  EXPECT_FALSE(boundary.is_in_duct({1.9, 0.3}));
  EXPECT_FALSE(boundary.is_in_duct({3.1, 0.3}));
}

/// Walls that the case draws beyond the opening are not drawn twice.
TEST(Ducts, BeginWhereTheWallsOfTheCaseEnd) {
  for (const double beyond : {0.37, 5.0}) {
    CaseSpec spec = open_channel();
    spec.walls[0].points.back() = {2.0 + beyond, 0.0};
    const std::vector<WallFace<2>> faces = duct_faces(with_ducts<2>(spec));
    ASSERT_EQ(faces.size(), beyond < 1.0 ? 1u : 0u);
    for (const WallFace<2>& face : faces) EXPECT_NEAR(face.corners[0][0], 2.0 + beyond, 1e-6);
  }
}

TEST(Ducts, OpeningsIntoAirHaveNone) {
  CaseSpec spec = open_channel();
  spec.outlets[0].beyond = Beyond::air;
  const Boundary<2> boundary = with_ducts<2>(spec);
  EXPECT_TRUE(duct_faces(boundary).empty());
  EXPECT_TRUE(boundary.ducts.empty());
}

/// An upright opening at the end of a wall, with this angle between the wall and the duct, measured in the water.
CaseSpec slot(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  CaseSpec spec = empty_case(0.1);
  const Vec<2> from = Vec<2>(0.0, 0.0) + 2.0 * Vec<2>(std::cos(angle), std::sin(angle));
  spec.walls = {polyline({{from[0], from[1]}, {0.0, 0.0}})};
  spec.outlets = {outlet({0.0, 0.0}, {0.0, 0.5})};
  return spec;
}

/// Behind the joint of a duct with a wall there are particles as behind any corner: all places up to three layers deep
/// have one within the diagonal of a cell, and none is in front of a wall.
TEST(Ducts, JoinWallsWithoutGapAtAnyAngle) {
  for (const double degrees : {180.0, 240.0, 270.0, 300.0, 150.0, 120.0}) {
    const Boundary<2> boundary = with_ducts<2>(slot(degrees));
    ASSERT_EQ(duct_faces(boundary).size(), 1u) << degrees;
    const WallParticles<2> dummies = make_dummy_particles<2>(boundary, 0.1, 3);
    for (std::size_t i = 0; i < dummies.size(); ++i) {
      if (dummies.is_beyond_end[i] != 0) continue;  // of the wall's other end
      const Vec<2>& x = dummies.position[i];
      EXPECT_LT(boundary.nearest(x, 1.0).signed_distance, 0.0) << degrees << ": " << x.transpose();
    }
    for (double x = -0.6; x < 0.3; x += 0.03) {
      for (double y = -0.6; y < 0.6; y += 0.03) {
        const Vec<2> place(x, y);
        const double depth = -boundary.nearest(place, 1.0).signed_distance;
        if (depth < 0.05 || depth > 0.25) continue;
        double nearest = 1.0;
        for (const Vec<2>& other : dummies.position) nearest = std::min(nearest, (place - other).norm());
        EXPECT_LT(nearest, 0.1 * std::sqrt(0.5) + 0.03) << degrees << ": " << place.transpose();
      }
    }
  }
}

/// A hole in an upright wall has a duct with two walls, whose corners with the wall are the wall's own.
TEST(Ducts, AHoleIsClosedOnBothSides) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0.0, 0.0}, {2.0, 0.0}, {2.0, 0.5}}), polyline({{2.0, 1.0}, {2.0, 2.0}})};
  spec.outlets = {outlet({2.0, 1.0}, {2.0, 0.5})};
  spec.outlets[0].level = 1.5;
  const Boundary<2> boundary = with_ducts<2>(spec);
  const std::vector<WallFace<2>> faces = duct_faces(boundary);
  ASSERT_EQ(faces.size(), 2u);
  for (const WallFace<2>& face : faces) EXPECT_GT(face.normal.dot(Vec<2>(2.5, 0.75) - face.corners[0]), 0.0);
  EXPECT_GT(boundary.nearest({2.3, 0.6}, 1.0).signed_distance, 0.0);
  EXPECT_LT(boundary.nearest({2.3, 0.4}, 1.0).signed_distance, 0.0);
  EXPECT_GT(boundary.nearest({1.9, 0.45}, 1.0).signed_distance, 0.0);
}

/// The tank of a channel in 3D: 1.0 m long, 0.5 m wide, 0.6 m high.
CaseSpec channel_in_3d() {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z", "+x"})};
  spec.fluid = {box_fluid({0, 0, 0}, {1.0, 0.5, 0.4})};
  spec.outlets = {outlet({1.0, 0.0, 0.0}, {1.0, 0.5, 0.6})};
  return spec;
}

TEST(Ducts, OfARectangleAreOpenWhereTheRimIs) {
  CaseSpec spec = channel_in_3d();
  for (const bool is_periodic : {false, true}) {
    if (is_periodic) {
      spec.walls[0].open = {"+z", "+x", "-y", "+y"};
      spec.domain.periodic_y = {0.0, 0.5};
    }
    double area = 0.0;
    for (const WallFace<3>& face : duct_faces(with_ducts<3>(spec))) {
      EXPECT_GT(face.height(Vec<3>(1.5, 0.25, 0.3)), 0.0) << "faces look inwards";
      area += face.measure();
    }
    EXPECT_NEAR(area, length * 0.1 * (is_periodic ? 0.5 : 0.5 + 2.0 * 0.6), 1e-9);
  }
}

/// The particles behind the walls of the box go on behind those of its duct, on the same lattice.
TEST(Ducts, OfARectangleGoOnWithTheLatticeOfItsBox) {
  CaseSpec spec = channel_in_3d();
  const Boundary<3> boundary = with_ducts<3>(spec);
  const auto count_beside = [&](double low, double high) {
    int count = 0;
    for (const Vec<3>& x : make_dummy_particles<3>(boundary, 0.1, 3).position) count += x[0] > low && x[0] < high;
    return count;
  };
  EXPECT_EQ(count_beside(1.0, 1.3), count_beside(0.7, 1.0));
  EXPECT_EQ(count_beside(0.9, 1.1), count_beside(0.7, 0.9)) << "across the joint";
}

/// A pipe around the x axis, its front inside.
TriangleMesh pipe(double radius, double end, int pieces) {
  TriangleMesh mesh;
  for (int k = 0; k < pieces; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / pieces;
    for (const double x : {0.0, end}) mesh.points.emplace_back(x, radius * std::cos(angle), radius * std::sin(angle));
  }
  for (int k = 0; k < pieces; ++k) {
    const int next = (k + 1) % pieces;
    add_quad(mesh, 2 * k, 2 * k + 1, 2 * next + 1, 2 * next);
  }
  return mesh;
}

TEST(Ducts, OfADiscAreTubes) {
  const double radius = 0.5;
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {folder.wall(pipe(radius, 2.0, 48), FluidSide::front)};
  OutletTable end;
  end.direction = {1.0, 0.0, 0.0};
  end.centre = {2.0, 0.0, 0.0};
  end.radius = radius;
  end.level = 0.4;
  spec.outlets = {end};
  const Boundary<3> boundary = with_ducts<3>(spec);
  double area = 0.0;
  for (const WallFace<3>& face : duct_faces(boundary)) {
    EXPECT_GT(face.height(Vec<3>(2.5, 0.0, 0.0)), 0.0);
    area += face.measure();
  }
  EXPECT_NEAR(area, 2.0 * std::numbers::pi * radius * length * 0.1, 0.02);
  ASSERT_EQ(boundary.meshes.size(), 2u);
  for (const double x : {1.5, 2.0, 2.3}) {
    EXPECT_GT(boundary.nearest({x, 0.0, 0.4}, 1.0).signed_distance, 0.0) << x;
    EXPECT_LT(boundary.nearest({x, 0.0, 0.6}, 1.0).signed_distance, 0.0) << x;
  }
}

/// The upright plane x = 1 around a square hole of 6 dx, its front towards -x.
TriangleMesh dam_with_hole() {
  TriangleMesh mesh;
  const std::array<double, 4> cuts{-0.4, 0.2, 0.8, 1.4};
  for (const double z : cuts) {
    for (const double y : cuts) mesh.points.emplace_back(1.0, y, z);
  }
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      if (i != 1 || j != 1) add_quad(mesh, 4 * j + i, 4 * (j + 1) + i, 4 * (j + 1) + i + 1, 4 * j + i + 1);
    }
  }
  return mesh;
}

/// The four walls of a square pipe behind that hole, their fronts inside.
TriangleMesh square_pipe() {
  TriangleMesh mesh;
  for (const double x : {1.0, 1.5}) {
    for (const auto& [y, z] : {std::pair(0.2, 0.2), std::pair(0.8, 0.2), std::pair(0.8, 0.8), std::pair(0.2, 0.8)}) {
      mesh.points.emplace_back(x, y, z);
    }
  }
  for (int k = 0; k < 4; ++k) add_quad(mesh, k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4);
  return mesh;
}

/// Behind the rim of a hole in a mesh begins another wall, that of a duct or a pipe, and in front of it is water.
TEST(Ducts, OfAHoleInAMeshHaveNoWallInside) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {folder.wall(dam_with_hole(), FluidSide::front)};
  CaseSpec with_pipe = spec;
  spec.outlets = {outlet({1.0, 0.2, 0.2}, {1.0, 0.8, 0.8})};
  spec.outlets[0].level = 1.0;
  with_pipe.walls.push_back(folder.wall(square_pipe(), FluidSide::front));
  with_pipe.walls.back().name = "pipe";
  for (const CaseSpec& one : {spec, with_pipe}) {
    const WallParticles<3> dummies = make_dummy_particles<3>(with_ducts<3>(one), 0.1, 3);
    double volume = 0.0;
    for (std::size_t i = 0; i < dummies.size(); ++i) {
      const Vec<3>& x = dummies.position[i];
      const bool is_inside = x[0] > 1.0 && x[0] < 1.4 && x[1] > 0.2 && x[1] < 0.8 && x[2] > 0.2 && x[2] < 0.8;
      if (is_inside) volume += dummies.share[i];
    }
    EXPECT_NEAR(volume, 0.0, 1e-9) << one.outlets.size();
  }
}

/// The part of a cell of the lattice, in which `x` is, that is beside a square section; 1: all of it.
double part_beside(const Vec<3>& x, const Vec<3>& origin, double low, double high) {
  double inside = 1.0;
  for (const int axis : {1, 2}) {
    const double from = origin[axis] + 0.1 * std::floor((x[axis] - origin[axis]) / 0.1);
    inside *= std::max(0.0, std::min(from + 0.1, high) - std::max(from, low)) / 0.1;
  }
  return 1.0 - inside;
}

/// Wherever the hole is on the lattice of the water, the space behind the dam and its duct is filled once, and the
/// section of the opening not at all.
TEST(Ducts, OfAHoleOffTheLatticeHaveNoWallInside) {
  const MeshFolder folder;
  for (const double off : {0.0, 0.05, 0.02}) {
    CaseSpec spec = empty_case(0.1, 3);
    spec.walls = {folder.wall(dam_with_hole(), FluidSide::front)};
    spec.outlets = {outlet({1.0, 0.2, 0.2}, {1.0, 0.8, 0.8})};
    spec.outlets[0].level = 1.0;
    const Vec<3> origin(0.0, off, off);
    spec.fluid = {box_fluid({0.0, off, off}, {1.0, off + 1.0, off + 1.0})};
    Boundary<3> boundary = make_boundary<3>(spec);
    const Lattice<3> lattice = lattice_behind_meshes(spec, boundary);
    append_ducts(spec, boundary);
    const WallParticles<3> dummies = make_dummy_particles<3>(boundary, 0.1, 3, {}, lattice);
    std::map<Cell<3>, double> volume;
    for (std::size_t i = 0; i < dummies.size(); ++i) {
      volume[cell_of<3>(dummies.position[i] - origin, 0.1)] += dummies.share[i];
    }
    int beside = 0;
    for (const double x : {1.05, 1.15, 1.25, 1.65}) {
      for (double y = 0.105; y < 0.9; y += 0.1) {
        for (double z = 0.105; z < 0.9; z += 0.1) {
          const Vec<3> place(x, y, z);
          const double part = part_beside(place, origin, 0.2, 0.8);
          // Parts of a cell, of which there are 27, are cut by one wall.
          EXPECT_NEAR(volume[cell_of<3>(place - origin, 0.1)], part, 1.0 / 27.0) << off << ": " << place.transpose();
          beside += part > 0.0 ? 1 : 0;
        }
      }
    }
    EXPECT_GE(beside, 4 * 28);
  }
}

/// Water that leaves a mouth meets walls that mirror it along the duct, and not in the plane of the mouth, although a
/// disc's duct and the hole around it are polygons with different corners.
TEST(Ducts, OfADiscMirrorTheJetAtTheirMouth) {
  const MeshFolder folder;
  TriangleMesh ring;  // the plane x = 0 around the hole, its front towards -x
  constexpr int pieces = 40;
  for (int k = 0; k < pieces; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / pieces;
    for (const double radius : {0.35, 1.0}) {
      ring.points.emplace_back(0.0, radius * std::cos(angle), radius * std::sin(angle));
    }
  }
  for (int k = 0; k < pieces; ++k) {
    const int next = (k + 1) % pieces;
    add_quad(ring, 2 * k, 2 * next, 2 * next + 1, 2 * k + 1);
  }
  CaseSpec spec = empty_case(0.1, 3);
  spec.fluid = {box_fluid({-1.0, -0.5, -0.5}, {0.0, 0.5, 0.5})};
  spec.walls = {folder.wall(ring, FluidSide::front)};
  OutletTable end;
  end.direction = {1.0, 0.0, 0.0};
  end.radius = 0.35;
  end.centre = {0.0, 0.0, 0.0};
  end.level = 1.0;
  spec.outlets = {end};
  Boundary<3> boundary = make_boundary<3>(spec);
  const Lattice<3> lattice = lattice_behind_meshes(spec, boundary);
  append_ducts(spec, boundary);
  const WallParticles<3> dummies = make_dummy_particles<3>(boundary, 0.1, 3, {}, lattice);
  int at_mouth = 0;
  for (std::size_t i = 0; i < dummies.size(); ++i) {
    const Vec<3>& x = dummies.position[i];
    const double aside = std::hypot(x[1], x[2]);
    if (x[0] < 0.0 || x[0] > 0.3 || aside > 0.6) continue;
    ++at_mouth;
    const bool can_turn = !dummies.beyond_edges[i].isZero(0.0);
    EXPECT_TRUE(can_turn || std::abs(dummies.normal[i][0]) < 0.1) << x.transpose();
  }
  EXPECT_GT(at_mouth, 200);
}

/// The top of a river's section meets gentle banks, which are beside it for many spacings and do not close it.
TEST(Ducts, OfARiverAreOpenAbove) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.02, 3);
  spec.walls = {
      folder.wall(sheet_mesh(8, [](double, double y) { return 0.1 * std::abs(2.0 * y - 1.0); }), FluidSide::above)};
  OutletTable end;
  end.direction = {1.0, 0.0, 0.0};
  end.through = {1.0, 0.5, 0.09};
  spec.outlets = {end};
  double area = 0.0;
  for (const WallFace<3>& face : duct_faces(with_ducts<3>(spec))) {
    EXPECT_GT(face.normal[2], 0.9);
    area += face.measure();
  }
  EXPECT_NEAR(area, 0.9 * std::hypot(1.0, 0.2) * length * 0.02, 1e-6);
}

/// Initial water stands in the duct as before its mouth, column by column, and nowhere else.
TEST(Ducts, HoldTheWaterThatStandsAtTheirMouth) {
  CaseSpec spec = channel_in_3d();
  spec.fluid[0].velocity = {0.3, 0.0, 0.0};
  const Boundary<3> drawn = make_boundary<3>(spec);
  const Boundary<3> boundary = with_ducts<3>(spec);
  FluidParticles<3> fluid = make_fluid_particles<3>(spec, drawn);
  const auto at_start = static_cast<std::size_t>(fluid.all);
  const auto water = water_in_ducts<3>(boundary.ducts, 0.1, fluid);
  EXPECT_EQ(water.size(), static_cast<std::size_t>(length) * 5u * 4u);
  append_water<3>(water, static_cast<std::int64_t>(water.size()), fluid);
  ASSERT_EQ(fluid.position.size(), at_start + water.size());
  for (std::size_t i = at_start; i < fluid.position.size(); ++i) {
    const Vec<3> steps = fluid.position[i] / 0.1 - Vec<3>::Constant(0.5);
    EXPECT_LT((steps - steps.each([](double x) { return std::round(x); })).norm(), 1e-9);
    EXPECT_GT(fluid.position[i][0], 1.0);
    EXPECT_LT(fluid.position[i][0], 2.0);
    EXPECT_NEAR(fluid.velocity[i][0], 0.3, 1e-15);
  }
  spec.fluid = {box_fluid({0, 0, 0}, {0.8, 0.5, 0.4})};
  EXPECT_TRUE(water_in_ducts<3>(boundary.ducts, 0.1, make_fluid_particles<3>(spec, drawn)).empty());
}

/// Across a mouth of 45 degrees the water's lattice has no columns. The duct's own fills it as densely.
TEST(Ducts, ThatLeanAreFilledAsDensely) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}}), polyline({{2.0, 1.0}, {1.0, 1.0}})};
  spec.fluid = {polygon_fluid({{0.0, 0.0}, {1.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}})};
  spec.outlets = {outlet({1.0, 0.0}, {2.0, 1.0})};
  const Boundary<2> boundary = with_ducts<2>(spec);
  const FluidParticles<2> fluid = make_fluid_particles<2>(spec, make_boundary<2>(spec));
  double volume = 0.0;
  double nearest = 1.0;
  for (const WaterParticle<2>& particle : water_in_ducts<2>(boundary.ducts, 0.05, fluid)) {
    volume += particle.volume;
    for (const Vec<2>& x : fluid.position) nearest = std::min(nearest, (x - particle.position).norm());
  }
  EXPECT_NEAR(volume, std::sqrt(2.0) * (length + lead_over_spacing) * 0.05, 1e-9) << "walls come at 45 degrees";
  EXPECT_GE(nearest, (0.5 - 1e-9) * 0.05);
}

}  // namespace
}  // namespace tailwater
