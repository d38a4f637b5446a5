// The last guard at walls.
#include "walls/wall_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/particle_set.h"
#include "support/rounding.h"

namespace tailwater {
namespace wall_contact_test {

constexpr double dx = 0.1;

/// Floor y = 0 and a wall x = 0 meet in the origin; the fluid is in the first quadrant. Fluid at `positions`, then one
/// wall particle, which is everybody's neighbour.
struct Corner {
  explicit Corner(std::vector<Vec<2>> positions) {
    boundary.walls.push_back({"wall", 0.0});
    boundary.faces.push_back({{Vec<2>(0.0, 5.0), Vec<2>(0.0, 0.0)}, Vec<2>(1.0, 0.0), 0});
    boundary.faces.push_back({{Vec<2>(0.0, 0.0), Vec<2>(5.0, 0.0)}, Vec<2>(0.0, 1.0), 0});
    const auto wall = static_cast<std::int32_t>(positions.size());
    positions.push_back(Vec<2>(2.0, -0.1));
    particles = fluid_at<2>(positions, dx);
    particles.kind[wall] = ParticleKind::wall;
    pairs.sees_wall.assign(positions.size(), 1);
    pairs.row_begin = {0};
    for (std::size_t i = 0; i < positions.size(); ++i) {
      pairs.j.push_back(wall);
      pairs.row_begin.push_back(pairs.j.size());
    }
  }

  std::size_t move(const std::vector<Vec<2>>& moves, std::span<Vec<2>> velocity) {
    const std::vector<Vec<2>> before = particles.position;
    for (std::size_t i = 0; i < moves.size(); ++i) particles.position[i] += moves[i];
    return keep_off_walls<2>(pairs, boundary, dx, {}, before, particles, velocity);
  }

  Boundary<2> boundary;
  Particles<2> particles;
  Pairs<2> pairs;
};

TEST(WallContact, CushionsTheWayToTheWallAndNothingElse) {
  const double half = 0.5 * dx;
  const std::vector<Vec<2>> start{{1.0, 3.0 * dx}, {1.0, half}, {1.0, 0.4 * dx}, {1.0, 0.2 * dx}, {0.2 * dx, 0.3 * dx}};
  const std::vector<Vec<2>> moves{{0.0, -2.4 * dx},   // ends more than dx/2 off
                                  {0.3 * dx, -half},  // the whole way: half of it is left
                                  {0.0, 0.1 * dx},    // away from the wall
                                  {0.0, -2.0 * dx},   // ends behind
                                  {-dx, -0.3 * dx}};  // into both walls of the corner
  Corner corner(start);
  const Vec<2> into(-1.0, -2.0);
  for (Vec<2>& velocity : corner.particles.velocity) velocity = into;
  corner.particles.velocity[2] = Vec<2>(0.5, 1.0);
  const Vec<2> wall = corner.particles.position[5];

  EXPECT_EQ(corner.move(moves, corner.particles.velocity), 2u);
  const std::vector<Vec<2>>& x = corner.particles.position;
  const std::vector<Vec<2>>& u = corner.particles.velocity;
  EXPECT_EQ(x[0], Vec<2>(start[0] + moves[0]));
  EXPECT_EQ(u[0], into);
  EXPECT_LT((x[1] - Vec<2>(1.0 + 0.3 * dx, 0.5 * half)).norm(), 4.0 * eps);
  EXPECT_LT((u[1] - Vec<2>(-1.0, -1.0)).norm(), 8.0 * eps);
  EXPECT_EQ(x[2], Vec<2>(start[2] + moves[2]));
  EXPECT_EQ(u[2], Vec<2>(0.5, 1.0));
  // gap/(1 + move/gap) for a move of 10 gaps
  EXPECT_LT((x[3] - Vec<2>(1.0, 0.2 * dx / 11.0)).norm(), 4.0 * eps);
  EXPECT_LT((u[3] - Vec<2>(-1.0, -2.0 / 11.0)).norm(), 8.0 * eps);
  EXPECT_LT((x[4] - Vec<2>(0.2 * dx / 6.0, 0.5 * 0.3 * dx)).norm(), 4.0 * eps);
  EXPECT_LT((u[4] - Vec<2>(-1.0 / 6.0, -1.0)).norm(), 8.0 * eps);
  EXPECT_EQ(x[5], wall);
}

TEST(WallContact, IsRelativeToAWallThatMoves) {
  // The wall x = 0 has come from x = -w, at w/dt; the same moves seen from it are those of a wall at rest.
  const double way = 0.3 * dx;
  const double dt = 0.01;
  const std::vector<Vec<2>> start{{1.0, 3.0 * dx}, {0.1 * dx, 3.0 * dx}, {0.4 * dx, 2.0 * dx}, {-0.1 * dx, 2.0 * dx}};
  const std::vector<Vec<2>> moves(start.size(), Vec<2>::Zero());
  Corner moving(start);
  WallDisplacements<2> displacements{.of_wall = std::vector<AffineMap<2>>(1), .dt = dt};
  displacements.of_wall[0].constant = Vec<2>(way, 0.0);
  EXPECT_EQ(keep_off_walls<2>(moving.pairs, moving.boundary, dx, displacements, start, moving.particles,
                              moving.particles.velocity),
            1u);
  Corner resting(start);
  std::vector<Vec<2>> before = start;
  for (Vec<2>& x : before) x[0] += way;
  for (Vec<2>& velocity : resting.particles.velocity) velocity = Vec<2>(-way / dt, 0.0);
  keep_off_walls<2>(resting.pairs, resting.boundary, dx, {}, before, resting.particles, resting.particles.velocity);
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_LT((moving.particles.position[i] - resting.particles.position[i]).norm(), 4.0 * eps);
    const Vec<2> relative = moving.particles.velocity[i] - Vec<2>(way / dt, 0.0);
    EXPECT_LT((relative - resting.particles.velocity[i]).norm(), 1e-12);
  }
  EXPECT_GT(moving.particles.velocity[1][0], 0.0);  // pushed along
  EXPECT_EQ(moving.particles.velocity[0], Vec<2>(Vec<2>::Zero()));
}

TEST(WallContact, NobodyCrossesHoweverFarAndNoVelocityIsTakenFromAMoveThatHadNone) {
  std::vector<Vec<2>> start, moves;
  for (int i = 1; i <= 20; ++i) {
    start.push_back(Vec<2>(0.05 * i * dx, 0.05 * (21 - i) * dx));
    moves.push_back(-0.1 * i * dx * Vec<2>(std::cos(i), 1.0));
  }
  Corner corner(start);
  for (Vec<2>& velocity : corner.particles.velocity) velocity = Vec<2>(-1.0, -1.0);
  corner.move(moves, {});
  for (std::size_t i = 0; i < start.size(); ++i) {
    EXPECT_GT(corner.particles.position[i].minCoeff(), 0.0);
    EXPECT_EQ(corner.particles.velocity[i], Vec<2>(-1.0, -1.0));
  }
}

TEST(WallContact, OverlapIsTheShareOfABallBehindTheWall) {
  const Corner corner({{1.0, 0.5 * dx}, {1.0, 0.25 * dx}, {1.0, 0.0}, {1.0, -0.3 * dx}, {1.0, 0.6 * dx}});
  std::vector<double> overlap(6, -1.0);
  find_wall_overlap<2>(corner.pairs, corner.boundary, dx, corner.particles, overlap);
  EXPECT_NEAR(overlap[0], 0.0, 4.0 * eps);
  EXPECT_NEAR(overlap[1], 5.0 / 32.0, 8.0 * eps);  // a cap of half the radius
  EXPECT_NEAR(overlap[2], 0.5, 8.0 * eps);
  EXPECT_NEAR(overlap[3], 0.5, 8.0 * eps);  // behind: no more than on it
  EXPECT_EQ(overlap[4], 0.0);
  EXPECT_EQ(overlap[5], 0.0);  // a wall
}

}  // namespace wall_contact_test
}  // namespace tailwater
