#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <vector>

#include "geometry/cases.h"
#include "sampling/fluid_particles.h"
#include "sampling/wall_particles.h"
#include "support/circle.h"

namespace tailwater {
namespace wall_particles_test {

using namespace testing_cases;

constexpr double round_off = 1e-12;

/// Dummy particles without those beyond the free ends of walls.
WallParticles<2> dummies_behind(Boundary<2> boundary, double spacing) {
  boundary.ends.clear();
  return make_dummy_particles<2>(boundary, spacing, 3);
}

template <int Dim>
int find_at(const WallParticles<Dim>& particles, const Vec<Dim>& x) {
  int found = -1;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if ((particles.position[i] - x).norm() < round_off) {
      EXPECT_EQ(found, -1) << "twice at " << x.transpose();
      found = static_cast<int>(i);
    }
  }
  return found;
}

template <int Dim>
double min_distance(const WallParticles<Dim>& particles) {
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, (particles.position[i] - particles.position[j]).norm());
  }
  return least;
}

template <int Dim>
int count_on_wall(const WallParticles<Dim>& particles) {
  int count = 0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    count += particles.is_on_wall(static_cast<std::int32_t>(i)) ? 1 : 0;
  return count;
}

template <int Dim>
void expect_behind_walls(const WallParticles<Dim>& particles, Boundary<Dim> boundary, double spacing) {
  boundary.ends.clear();  // beyond a free end nothing is behind the wall
  for (const Vec<Dim>& x : particles.position) {
    EXPECT_LE(boundary.nearest(x, 1e9).signed_distance, -(0.5 - 1e-6) * spacing) << x.transpose();
  }
  EXPECT_GE(min_distance(particles), (0.5 - 1e-6) * spacing);
}

// One bed drawn from a crest and from a trough: a wall goes on in the next period.
TEST(Dummies, DoNotDependOnWhereAPeriodBegins) {
  CaseSpec spec = empty_case(0.1);
  spec.domain.periodic_x = {0.0, 2.4};
  spec.walls = {polyline({{0.0, 0.0}, {0.6, 0.3}, {1.2, 0.0}, {1.8, 0.2}, {2.4, 0.0}})};
  const WallParticles<2> from_trough = make_dummy_particles<2>(make_boundary<2>(spec), 0.1, 3);
  spec.walls = {polyline({{0.0, 0.3}, {0.6, 0.0}, {1.2, 0.2}, {1.8, 0.0}, {2.4, 0.3}})};
  const WallParticles<2> from_crest = make_dummy_particles<2>(make_boundary<2>(spec), 0.1, 3);
  ASSERT_EQ(from_crest.size(), from_trough.size());
  for (std::size_t i = 0; i < from_crest.size(); ++i) {
    Vec<2> x = from_crest.position[i] + Vec<2>(0.6, 0.0);
    if (x[0] > 2.4 - round_off) x[0] -= 2.4;
    const int same = find_at<2>(from_trough, x);
    ASSERT_GE(same, 0) << x.transpose();
    EXPECT_LT((from_crest.blocked[i] - from_trough.blocked[same]).norm(), round_off) << x.transpose();
    const Mat<2>& beyond = from_crest.beyond_edges[i];  // normals in columns, in any order
    const Mat<2>& expected = from_trough.beyond_edges[same];
    EXPECT_LT((beyond * beyond.transpose() - expected * expected.transpose()).norm(), round_off) << x.transpose();
    EXPECT_NEAR(from_crest.share[i], from_trough.share[same], round_off) << x.transpose();
  }
}

// The wall is extended by the depth of its layers beyond each end at which no wall of the same body stands.
TEST(Dummies, ContinueAWallBeyondItsFreeEnds) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {polyline({{0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0}}), polyline({{1.0, 0.0}, {1.0, 1.0}})};
  const Boundary<2> boundary = make_boundary<2>(spec);
  const WallParticles<2> all = make_dummy_particles<2>(boundary, 0.1, 3);
  const WallParticles<2> behind = dummies_behind(boundary, 0.1);
  EXPECT_EQ(std::ranges::count(all.is_beyond_end, 1), 2 * 9);
  EXPECT_EQ(all.size(), behind.size() + 2 * 9);
  for (const double x : {-0.25, -0.15, -0.05, 1.05, 1.15, 1.25}) {
    for (const double z : {1.05, 1.15, 1.25}) {
      const int found = find_at<2>(all, {x, z});
      ASSERT_GE(found, 0) << x << " " << z;
      EXPECT_EQ(all.is_beyond_end[found], 1);
    }
  }
}

// All lattice points outside the fluid's quarter-plane corners, within three layers, and no others.
TEST(Dummies, ContinueTheLatticeAroundATank) {
  const CaseSpec spec = tank();
  const Boundary<2> boundary = make_boundary<2>(spec);
  const WallParticles<2> dummies = dummies_behind(boundary, 0.1);
  ASSERT_EQ(dummies.size(), 2u * 3 * 6 + 3 * 10 + 2 * 9) << "sides, bed, two corner patches of 3 x 3";
  for (int i = -3; i < 13; ++i) {
    for (int j = -3; j < 6; ++j) {
      const bool left = i < 0, right = i >= 10, below = j < 0;
      const int found = find_at<2>(dummies, {(i + 0.5) * 0.1, (j + 0.5) * 0.1});
      ASSERT_EQ(found >= 0, left || right || below) << i << ", " << j;
      if (found < 0) {
        continue;
      }
      const Vec<2> normals(left ? 1.0 : right ? -1.0 : 0.0, below ? 1.0 : 0.0);
      EXPECT_LT((dummies.normal[found] - normals.normalized()).norm(), round_off);
      const Mat<2> blocked = normals.cwiseProduct(normals).asDiagonal();
      EXPECT_LT((dummies.blocked[found] - blocked).norm(), round_off);
    }
  }
  expect_behind_walls(dummies, boundary, 0.1);
}

TEST(Dummies, DoNotDependOnHowTheWallIsWritten) {
  CaseSpec spec = tank();
  const WallParticles<2> expected = dummies_behind(make_boundary<2>(spec), 0.1);
  const std::vector<std::vector<WallTable>> ways = {
      {polyline({{1.0, 0.6}, {1.0, 0.0}, {0.0, 0.0}, {0.0, 0.6}}, FluidSide::right)},
      {box_wall({0, 0}, {1.0, 0.6}, {"+y"})},
      {polyline({{0.0, 0.6}, {0.0, 0.0}, {0.35, 0.0}}),
       polyline({{1.0, 0.6}, {1.0, 0.0}, {0.35, 0.0}}, FluidSide::right)},
  };
  for (const std::vector<WallTable>& walls : ways) {
    spec.walls = walls;
    const WallParticles<2> dummies = dummies_behind(make_boundary<2>(spec), 0.1);
    ASSERT_EQ(dummies.size(), expected.size());
    for (const Vec<2>& x : expected.position) {
      EXPECT_GE(find_at<2>(dummies, x), 0) << x.transpose();
    }
  }
}

// Drawn by hand, walls end a little before or beyond each other. Rows of their own left the corner behind them empty,
// and still water escaped there.
TEST(Dummies, FillTheCornerOfWallsThatNearlyMeet) {
  constexpr double dx = 0.05;
  const auto dummies = [&](double beyond, double below) {
    CaseSpec spec = empty_case(dx);
    spec.walls = {polyline({{0.0, 0.6}, {0.0, -below}}), polyline({{-beyond, 0.0}, {1.0, 0.0}, {1.0, 0.6}})};
    return make_dummy_particles<2>(make_boundary<2>(spec), dx, 3).position;
  };
  const std::vector<Vec<2>> closed = dummies(0.0, 0.0);
  for (const auto& [beyond, below] :
       {std::pair{0.01, 0.0}, {0.5, 0.0}, {0.9, 0.0}, {0.3, 0.3}, {0.0, 0.2}, {-0.3, 0.0}}) {
    const std::vector<Vec<2>> rows = dummies(beyond * dx, below * dx);
    ASSERT_EQ(rows.size(), closed.size()) << beyond << ' ' << below;
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_LT((rows[i] - closed[i]).norm(), 1e-9 * dx) << beyond;
  }
}

// A block whose foot is a little below the bed. Each of the two walls is behind the other there. The dummies of both
// were left out, and still water escaped at the edge of the block at 3 m/s.
template <int Dim>
void expect_dummies_below_block() {
  constexpr double dx = 0.1;
  for (const double depth : {0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 1.0, 1.4}) {
    const double foot = -depth * dx;
    CaseSpec spec = empty_case(dx);
    if constexpr (Dim == 2) {
      spec.walls = {box_wall({0, 0}, {3, 1}, {"+y"}), box_wall({1, foot}, {2, 0.5}, {}, FluidSide::outside)};
    } else {
      spec.walls = {box_wall({0, 0, 0}, {3, 2, 1}, {"+z"}),
                    box_wall({1, 0.5, foot}, {2, 1.5, 0.5}, {}, FluidSide::outside)};
    }
    const WallParticles<Dim> dummies = make_dummy_particles<Dim>(make_boundary<Dim>(spec), dx, 3, {}, {});
    for (const double x : {1.05, 1.15}) {
      for (const double z : {-0.05, 0.05}) {
        Vec<Dim> place = Vec<Dim>::Constant(z);
        place[0] = x;
        if constexpr (Dim == 3) place[1] = 0.75;
        const bool is_filled = std::ranges::any_of(
            dummies.position, [&](const Vec<Dim>& dummy) { return (dummy - place).norm() < 0.51 * dx; });
        EXPECT_TRUE(is_filled) << Dim << "D, foot at " << foot << ", none near " << place.transpose();
      }
    }
  }
}

TEST(Dummies, FillTheBedBelowTheEdgeOfABlock) {
  expect_dummies_below_block<2>();
  expect_dummies_below_block<3>();
}

// A block of 1.0 x 0.8 m in the water: its interior is filled with rings, which shrink at its convex corners.
TEST(Dummies, ShrinkAtConvexCorners) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {box_wall({0, 0}, {1.0, 0.8}, {}, FluidSide::outside)};
  const Boundary<2> boundary = make_boundary<2>(spec);
  const WallParticles<2> dummies = dummies_behind(boundary, 0.1);
  EXPECT_EQ(dummies.size(), 10u * 8 - 4 * 2);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 8; ++j) {
      const int depth = std::min({i, 9 - i, j, 7 - j});
      EXPECT_EQ(find_at<2>(dummies, {(i + 0.5) * 0.1, (j + 0.5) * 0.1}) >= 0, depth < 3) << i << ", " << j;
    }
  }
  expect_behind_walls(dummies, boundary, 0.1);
}

TEST(Dummies, SkipRowsThatHaveFlipped) {
  CaseSpec spec = empty_case(0.1);
  spec.walls = {box_wall({0, 0}, {0.3, 2.0}, {}, FluidSide::outside)};
  const WallParticles<2> dummies = dummies_behind(make_boundary<2>(spec), 0.1);
  EXPECT_EQ(dummies.size(), 3u * 20u) << "three cells wide: two rings, the inner one a single column";
  EXPECT_NEAR(min_distance(dummies), 0.1, round_off);
}

// A bed that rises by 45 degrees and, mirrored, one that falls: rows meet on the bisector.
TEST(Dummies, MeetOnTheBisectorOfA45DegreeCorner) {
  const double dx = 0.1;
  for (const double turn : {1.0, -1.0}) {
    CaseSpec spec = empty_case(dx);
    spec.walls = {polyline({{-1, 0}, {0, 0}, {1, turn}})};
    const Boundary<2> boundary = make_boundary<2>(spec);
    const WallParticles<2> dummies = dummies_behind(boundary, dx);
    expect_behind_walls(dummies, boundary, dx);
    const double half = turn * std::numbers::pi / 8;
    for (int layer = 0; layer < 3; ++layer) {
      // Towards the solid along the bisector, (sin, -cos) of half the turn, at the row's depth behind both faces.
      const double reach = (layer + 0.5) * dx / std::cos(half);
      const int found = find_at<2>(dummies, Vec<2>(std::sin(half), -std::cos(half)) * reach);
      ASSERT_GE(found, 0) << "layer " << layer;
      EXPECT_LT((dummies.normal[found] - Vec<2>(-std::sin(half), std::cos(half))).norm(), round_off);
      // Sum of two n n^T at 45 degrees: eigenvalues 1 +- cos 45, along the mean normal and across it.
      const Mat<2> blocked = dummies.blocked[found];
      EXPECT_NEAR(blocked.trace(), 1.0 + (1.0 - std::numbers::sqrt2 / 2), round_off);
      EXPECT_LT((blocked * dummies.normal[found] - dummies.normal[found]).norm(), round_off);
    }
  }
}

TEST(Dummies, StayNearASharpCorner) {
  const double dx = 0.1;
  CaseSpec spec = empty_case(dx);
  spec.walls = {polyline({{2.0, 0.8}, {0, 0}, {2.0, -0.8}})};  // fluid within 2 x 21.8 degrees
  const Boundary<2> boundary = make_boundary<2>(spec);
  const WallParticles<2> dummies = dummies_behind(boundary, dx);
  expect_behind_walls(dummies, boundary, dx);
  for (const Vec<2>& x : dummies.position) {
    EXPECT_GE(boundary.nearest(x, 10.0).signed_distance, -1.5 * 3 * dx * (1 + 1e-9));
  }
}

TEST(Dummies, FollowASmoothCurveEvenly) {
  const double dx = 0.1;
  CaseSpec spec = empty_case(dx);
  spec.walls = {polygon(circle(200), FluidSide::outside)};
  const WallParticles<2> dummies = dummies_behind(make_boundary<2>(spec), dx);
  // Rows of radius 0.95, 0.85, 0.75 with N = round(2 pi r/dx).
  EXPECT_EQ(dummies.size(), 60u + 53u + 47u);
}

TEST(Dummies, StopAtAnotherWall) {
  const double dx = 0.1;
  CaseSpec spec = empty_case(dx);
  spec.walls = {polyline({{0, 0}, {1, 0}}), polyline({{0, -0.2}, {1, -0.2}}, FluidSide::right)};
  const Boundary<2> boundary = make_boundary<2>(spec);
  const WallParticles<2> dummies = dummies_behind(boundary, dx);
  EXPECT_EQ(dummies.size(), 20u) << "a plate two spacings thick holds two rows";
  for (const Vec<2>& x : dummies.position) {
    EXPECT_LT(std::abs(x[1] + 0.1), 0.1);
  }
}

TEST(Dummies, FillTheShellOfABoxIn3D) {
  const double dx = 0.1;
  CaseSpec spec = empty_case(dx, 3);
  spec.walls = {box_wall({0, 0, 0}, {0.5, 0.4, 0.6}, {"+z"})};
  const Boundary<3> boundary = make_boundary<3>(spec);
  const WallParticles<3> dummies = make_dummy_particles<3>(boundary, dx, 3);
  ASSERT_EQ(dummies.size(), (5u + 6) * (4 + 6) * (6 + 3) - 5 * 4 * 6) << "nothing stands above the open top";
  for (int i = -3; i < 8; ++i) {
    for (int j = -3; j < 7; ++j) {
      for (int k = -3; k < 6; ++k) {
        const Vec<3> normals(i < 0 ? 1.0 : i >= 5 ? -1.0 : 0.0, j < 0 ? 1.0 : j >= 4 ? -1.0 : 0.0, k < 0 ? 1.0 : 0.0);
        const int found = find_at<3>(dummies, {(i + 0.5) * dx, (j + 0.5) * dx, (k + 0.5) * dx});
        ASSERT_EQ(found >= 0, !normals.isZero());
        if (found >= 0) {
          EXPECT_LT((dummies.normal[found] - normals.normalized()).norm(), round_off);
          const Mat<3> blocked = normals.cwiseProduct(normals).asDiagonal();
          EXPECT_LT((dummies.blocked[found] - blocked).norm(), round_off);
        }
      }
    }
  }
  expect_behind_walls(dummies, boundary, dx);
}

/// m^Dim
template <int Dim>
double volume_of(const WallParticles<Dim>& particles, double spacing) {
  return std::accumulate(particles.share.begin(), particles.share.end(), 0.0) * power<Dim>(spacing);
}

TEST(Dummies, HaveTheVolumeBehindABoxOfAnySize) {
  const double dx = 0.1;
  CaseSpec tank = empty_case(dx, 3);
  tank.walls = {box_wall({0, 0, 0}, {0.75, 0.64, 0.57}, {"+z"})};
  EXPECT_NEAR(volume_of(make_dummy_particles<3>(make_boundary<3>(tank), dx, 3), dx),
              (0.75 + 0.6) * (0.64 + 0.6) * (0.57 + 0.3) - 0.75 * 0.64 * 0.57, round_off);
  CaseSpec body = empty_case(dx, 3);
  body.walls = {box_wall({0, 0, 0}, {0.45, 0.34, 0.57}, {}, FluidSide::outside)};
  EXPECT_NEAR(volume_of(make_dummy_particles<3>(make_boundary<3>(body), dx, 3), dx), 0.45 * 0.34 * 0.57, round_off);
}

// Rows that end at the tank's rim.
TEST(Dummies, HaveTheVolumeBehindATankOfAnySizeIn2D) {
  const double dx = 0.1;
  CaseSpec spec = empty_case(dx);
  spec.walls = {polyline({{0, 0.57}, {0, 0}, {0.75, 0}, {0.75, 0.57}})};
  EXPECT_NEAR(volume_of(dummies_behind(make_boundary<2>(spec), dx), dx), (0.75 + 0.6) * (0.57 + 0.3) - 0.75 * 0.57,
              round_off);
}

/// Volume of the particles of wall 0 below the floor z or y = 0 of a tank 1 m long, up to `end` along x.
template <int Dim>
double volume_below_floor(const CaseSpec& spec, double end) {
  const WallParticles<Dim> particles = make_dummy_particles<Dim>(make_boundary<Dim>(spec), 0.1, 3);
  double volume = 0.0;
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const Vec<Dim>& x = particles.position[row];
    const bool is_across = Dim == 2 || (x[1] > 0.0 && x[1] < 0.6);
    const bool counts = particles.wall[row] == 0 && x[0] > 0.0 && x[0] < end && x[Dim - 1] < 0.0 && is_across;
    if (counts) volume += particles.share[row] * power<Dim>(0.1);
  }
  return volume;
}

/// A plate divides the cells of the floor on which it ends: the dummies on its either side fill the space there,
/// wherever it stands.
TEST(Dummies, AreDividedByAPlateThatEndsOnTheirWall) {
  for (const double at : {0.5, 0.517, 0.537, 0.58}) {
    CaseSpec flat = empty_case(0.1);
    flat.walls = {polyline({{0, 1}, {0, 0}, {1, 0}, {1, 1}}), polyline({{at, 0}, {at, 0.3}})};
    flat.walls[1].shape = WallShape::plate;
    EXPECT_NEAR(volume_below_floor<2>(flat, at), 0.3 * at, round_off);
    EXPECT_NEAR(volume_below_floor<2>(flat, 1.0), 0.3, round_off);
    CaseSpec spec = empty_case(0.1, 3);
    spec.walls = {box_wall({0, 0, 0}, {1, 0.6, 1}, {"+z"}),
                  polyline({{at, 0, 0}, {at, 0.6, 0}, {at, 0.6, 0.3}, {at, 0, 0.3}})};
    spec.walls[1].shape = WallShape::plate;
    EXPECT_NEAR(volume_below_floor<3>(spec, at), 0.3 * 0.6 * at, round_off);
  }
}

TEST(Dummies, HaveTheVolumeOfTheirRowsBehindAPlateIn3D) {
  const double dx = 0.1;
  CaseSpec spec = empty_case(dx, 3);
  WallTable plate = polyline({{0, 0, 0}, {0.75, 0, 0}, {0.75, 0, 0.66}, {0, 0, 0.66}});
  plate.shape = WallShape::plate;
  spec.walls = {plate};
  const double steps_along = 8 + 2 * 3;
  const double steps_up = 7 + 2 * 3;
  EXPECT_NEAR(volume_of(make_dummy_particles<3>(make_boundary<3>(spec), dx, 3), dx),
              2 * (3 * dx) * (steps_along * 0.75 / 8) * (steps_up * 0.66 / 7), round_off);
}

TEST(Dummies, FillAnObstacleIn3DFromItsClosedFaces) {
  const double dx = 0.1;
  CaseSpec spec = empty_case(dx, 3);
  spec.walls = {box_wall({0, 0, 0}, {0.8, 0.8, 0.8}, {"-z"}, FluidSide::outside)};
  const WallParticles<3> dummies = make_dummy_particles<3>(make_boundary<3>(spec), dx, 3);
  EXPECT_EQ(dummies.size(), 8u * 8 * 8 - 2 * 2 * 5) << "but for a core two cells wide that reaches the open bottom";
  const int edge = find_at<3>(dummies, {0.15, 0.35, 0.65});
  ASSERT_GE(edge, 0);
  EXPECT_LT((dummies.normal[edge] - Vec<3>(-1, 0, 1).normalized()).norm(), round_off) << "one deep in both";
}

TEST(SurfaceParticles, StandOnTheWallWithItsEndsAndCorners) {
  const CaseSpec spec = tank();
  const WallParticles<2> row = make_surface_particles<2>(make_boundary<2>(spec), 0.1);
  ASSERT_EQ(row.size(), 6u + 11u + 6u);
  for (int i = 0; i <= 10; ++i) {
    EXPECT_GE(find_at<2>(row, {i * 0.1, 0.0}), 0);
  }
  const int corner = find_at<2>(row, {1.0, 0.0});
  EXPECT_LT((row.normal[corner] - Vec<2>(-1, 1).normalized()).norm(), round_off);
  EXPECT_LT((row.blocked[corner] - Mat<2>::Identity()).norm(), round_off);
  EXPECT_GE(find_at<2>(row, {0.0, 0.6}), 0) << "the rim";
}

TEST(RowAndDummies, AreOneLatticeBehindTheWall) {
  const CaseSpec spec = tank();
  const WallParticles<2> rows = make_row_and_dummy_particles<2>(make_boundary<2>(spec), 0.1, 3);
  EXPECT_EQ(count_on_wall(rows), 6 + 11 + 6);
  EXPECT_EQ(rows.size(), 3u * 7 * 2 + 9 * 3 + 2 * 3 * 2)
      << "sides from the rim to the floor, floor between, corners below";
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec<2>& x = rows.position[k];
    const double depth = std::max({-x[0], x[0] - 1.0, -x[1]});
    EXPECT_EQ(rows.is_on_wall(static_cast<std::int32_t>(k)), depth < 0.05);
    for (int d = 0; d < 2; ++d) EXPECT_NEAR(x[d] / 0.1, std::round(x[d] / 0.1), 1e-9) << x.transpose();
  }
}

TEST(RowAndDummies, SurroundABoxIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {0.5, 0.4, 0.6}, {"+z"})};
  const WallParticles<3> nodes = make_row_and_dummy_particles<3>(make_boundary<3>(spec), 0.1, 3);
  EXPECT_EQ(count_on_wall(nodes), 6 * 5 * 7 - 4 * 3 * 6);
  EXPECT_EQ(nodes.size(), 10u * 9 * 9 - 4 * 3 * 6) << "two nodes more on each closed side";
  const int behind = find_at<3>(nodes, {-0.2, 0.2, -0.1});
  ASSERT_GE(behind, 0);
  EXPECT_LT((nodes.normal[behind] - Vec<3>(1, 0, 1).normalized()).norm(), round_off);
}

TEST(RowAndDummies, FillAnObstacleIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {0.8, 0.8, 0.8}, {"-z"}, FluidSide::outside)};
  const WallParticles<3> nodes = make_row_and_dummy_particles<3>(make_boundary<3>(spec), 0.1, 2);
  EXPECT_EQ(nodes.size(), 9u * 9 * 9 - 5 * 5 * 7) << "but for a core three nodes deep that reaches the open bottom";
}

TEST(SurfaceParticles, CoverTheClosedFacesOfABoxIn3D) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {0.5, 0.4, 0.6}, {"+z"})};
  const WallParticles<3> nodes = make_surface_particles<3>(make_boundary<3>(spec), 0.1);
  EXPECT_EQ(nodes.size(), 6u * 5 * 7 - 4 * 3 * 6) << "all nodes but those inside and on the open top";
  const int corner = find_at<3>(nodes, {0.0, 0.4, 0.0});
  ASSERT_GE(corner, 0);
  EXPECT_LT((nodes.normal[corner] - Vec<3>(1, -1, 1).normalized()).norm(), round_off);
  EXPECT_LT((nodes.blocked[corner] - Mat<3>::Identity()).norm(), round_off);
}

// A block on a bed: particles behind its sides and its top have the normals of both up to 3 dx from the edge. The
// corners between bed and block, those of the tank, and a round body have no convex edge.
TEST(Dummies, KnowTheWallsBeyondConvexEdges) {
  CaseSpec spec = tank();
  const double top = 0.5;
  spec.walls.push_back(box_wall({0.4, 0.0}, {0.7, top}, {}, FluidSide::outside));
  const WallParticles<2> dummies = dummies_behind(make_boundary<2>(spec), 0.1);
  const auto at = [&](double x, double z) { return dummies.beyond_edges[find_at<2>(dummies, {x, z})]; };
  for (std::size_t i = 0; i < dummies.size(); ++i) {
    const bool is_of_tank = dummies.wall[i] == 0;
    EXPECT_TRUE(!is_of_tank || dummies.beyond_edges[i].isZero(0.0)) << dummies.position[i].transpose();
  }
  EXPECT_EQ(at(0.45, top - 0.15), (Mat<2>{{0.0, 1.0}, {1.0, 0.0}})) << "left, near the top: top, right";
  const Vec<2> row = at(0.55, top - 0.05).col(0).cwiseAbs();
  EXPECT_EQ(row, Vec<2>(1.0, 0.0)) << "top: a side";

  spec.walls = {polygon(circle(24, 0.3), FluidSide::right)};
  const WallParticles<2> round = dummies_behind(make_boundary<2>(spec), 0.1);
  ASSERT_GT(round.size(), 0u);
  for (const Mat<2>& beyond : round.beyond_edges) EXPECT_TRUE(beyond.isZero(0.0));
}

// A crest of 60 degrees, whose first mitre is a whole dx behind it: water dx/2 in front of the tip has a particle dx/2
// behind the tip. A right angle keeps its lattice.
TEST(Dummies, FillTheTipOfASharpCrest) {
  CaseSpec spec = empty_case(0.1);
  const double half = 0.6 / std::numbers::sqrt3;
  spec.walls = {polyline({{0.0, 0.0}, {1.0, 0.0}, {1.0 + half, 0.6}, {1.0 + 2.0 * half, 0.0}, {3.0, 0.0}})};
  const Boundary<2> sharp = make_boundary<2>(spec);
  const WallParticles<2> dummies = dummies_behind(sharp, 0.1);
  EXPECT_GE(find_at<2>(dummies, {1.0 + half, 0.55}), 0);
  EXPECT_GE(find_at<2>(dummies, {1.0 + half, 0.50}), 0);
  EXPECT_GE(min_distance(dummies), (0.5 - 1e-6) * 0.1);
  for (const Vec<2>& x : dummies.position) EXPECT_LT(sharp.nearest(x, 1e9).signed_distance, 0.0) << x.transpose();

  spec.walls = {box_wall({0.0, 0.0}, {1.0, 1.0}, {}, FluidSide::outside)};
  EXPECT_EQ(dummies_behind(make_boundary<2>(spec), 0.1).size(), 100u - 16u);
}

/// Parts of space, in cubes of 8 dx, together have all particles, each once and unchanged; particles of moving walls
/// are in every part.
template <int Dim>
void expect_shares_to_be_all(const Boundary<Dim>& boundary, double dx, bool starts_on_wall, int shares) {
  const auto make = [&](const SpaceShare& share) {
    return starts_on_wall ? make_row_and_dummy_particles(boundary, dx, 3, share)
                          : make_dummy_particles(boundary, dx, 3, share);
  };
  const WallParticles<Dim> all = make({});
  std::map<std::int64_t, std::size_t> row_of_number;
  for (std::size_t row = 0; row < all.size(); ++row) row_of_number[all.number[row]] = row;
  ASSERT_EQ(row_of_number.size(), all.size()) << "numbers are unique";
  EXPECT_LT(row_of_number.rbegin()->first, all.numbers);
  std::vector<int> made(all.size(), 0);
  std::size_t most = 0;
  for (int share = 0; share < shares; ++share) {
    const WallParticles<Dim> part = make({.edge = 8.0 * dx, .share = share, .shares = shares});
    EXPECT_EQ(part.numbers, all.numbers);
    EXPECT_EQ(part.numbers_on_wall, all.numbers_on_wall);
    most = std::max(most, part.size());
    for (std::size_t k = 0; k < part.size(); ++k) {
      ASSERT_TRUE(row_of_number.contains(part.number[k])) << part.position[k].transpose();
      const std::size_t row = row_of_number[part.number[k]];
      ++made[row];
      EXPECT_EQ(part.position[k], all.position[row]);
      EXPECT_EQ(part.normal[k], all.normal[row]);
      EXPECT_EQ(part.blocked[k], all.blocked[row]);
      EXPECT_EQ(part.beyond_edges[k], all.beyond_edges[row]);
      EXPECT_EQ(part.share[k], all.share[row]);
      EXPECT_EQ(part.wall[k], all.wall[row]);
    }
  }
  EXPECT_LT(most, all.size() * 3 / 4) << "no share has most";
  for (std::size_t row = 0; row < all.size(); ++row) {
    EXPECT_EQ(made[row], boundary.walls[all.wall[row]].moves() ? shares : 1) << all.position[row].transpose();
  }
}

TEST(SharesOfSpace, HaveAllParticlesOfATankWithAPlateAndABodyIn2D) {
  CaseSpec spec = empty_case(0.05);
  spec.walls = {polyline({{0.0, 2.0}, {0.0, 0.0}, {1.3, 0.21}, {2.6, 0.0}, {3.0, 0.0}, {3.0, 2.0}})};
  spec.walls.push_back(box_wall({1.03, 0.9}, {1.52, 1.2}, {}, FluidSide::outside));
  spec.walls.push_back(box_wall({2.0, 1.0}, {2.2, 1.4}, {}, FluidSide::outside));
  spec.walls.back().displacement = {"0.1*t", 0.0};
  for (const int shares : {2, 5}) {
    expect_shares_to_be_all(make_boundary<2>(spec), 0.05, true, shares);
    WallTable plate = polyline({{0.5, 0.0}, {0.5, 1.7}});
    plate.shape = WallShape::plate;
    spec.walls.push_back(plate);
    expect_shares_to_be_all(make_boundary<2>(spec), 0.05, false, shares);
    spec.walls.pop_back();
  }
}

TEST(SharesOfSpace, HaveAllParticlesOfBoxesThatTouchIn3D) {
  CaseSpec spec = empty_case(0.05, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.6, 1.0, 0.8}, {"+z"}),
                box_wall({0.41, 0.43, 0}, {0.93, 0.81, 0.42}, {"-z"}, FluidSide::outside)};
  for (const int shares : {2, 5}) {
    expect_shares_to_be_all(make_boundary<3>(spec), 0.05, false, shares);
    expect_shares_to_be_all(make_boundary<3>(spec), 0.05, true, shares);
  }
}

// A block with sharp edges, in a zone of twice as many particles per length.
TEST(WallParticlesInAZone, HaveTheNormalsOfTheFinerSpacingBesideEdges) {
  CaseSpec spec = empty_case(0.1);
  spec.fluid = {box_fluid({-2.0, -2.0}, {2.0, 2.0})};
  spec.walls = {polyline({{-1.0, -2.0}, {-1.0, 1.0}, {1.0, 1.0}, {1.0, -2.0}})};
  RefinementTable zone;
  zone.min = {-9.0, -9.0};
  zone.max = {9.0, 9.0};
  spec.refinement = {zone};
  Boundary<2> boundary = make_boundary<2>(spec);
  WallParticles<2> divided = dummies_behind(boundary, 0.1);
  boundary.ends.clear();
  divide_wall_particles<2>(SpacingField<2>(spec, boundary), boundary, 0.1, 3, {}, {}, divided);
  const WallParticles<2> fine = dummies_behind(boundary, 0.05);
  int compared = 0;
  int at_edges = 0;
  for (std::size_t i = 0; i < divided.size(); ++i) {
    const int same = find_at<2>(fine, divided.position[i]);
    if (same < 0) continue;
    ++compared;
    at_edges += fine.beyond_edges[same].isZero(0.0) ? 0 : 1;
    EXPECT_NEAR((divided.normal[i] - fine.normal[same]).norm(), 0.0, round_off) << divided.position[i];
    EXPECT_NEAR((divided.blocked[i] - fine.blocked[same]).cwiseAbs().maxCoeff(), 0.0, round_off);
    EXPECT_NEAR((divided.beyond_edges[i] - fine.beyond_edges[same]).cwiseAbs().maxCoeff(), 0.0, round_off);
  }
  EXPECT_GT(compared, 200);
  EXPECT_GT(at_edges, 10);
}

}  // namespace wall_particles_test
}  // namespace tailwater
