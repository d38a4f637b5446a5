// Wall velocities, wall friction and the last guard at walls.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "closures/viscosity.h"
#include "closures/wall_contact.h"
#include "closures/wall_velocity.h"
#include "support/dimensions.h"
#include "support/particle_set.h"

namespace tailwater {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double dx = 0.1;

template <class D>
class WallTest : public testing::Test {};
TYPED_TEST_SUITE(WallTest, Dimensions);

/// A cube of fluid above the plane y = 0 and two layers of wall particles under it (a third would be 3 dx away), plus
/// one wall particle far from everything, last, which is dry. All of them block what `blocked` projects on.
template <int Dim>
struct WettedWall {
  WettedWall(const Mat<Dim>& blocked, double friction, WallTreatment treatment)
      : set(particles(), make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx), dx),
        fluid_weight(set.size()),
        is_wet(set.size()),
        mean(set.size(), Vec<Dim>::Zero()) {
    walls.treatment = treatment;
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (set.particles.is_fluid(i)) continue;
      walls.particles.position.push_back(set.position(i));
      walls.particles.normal.push_back(Vec<Dim>::UnitY());
      walls.particles.blocked.push_back(blocked);
      walls.particles.wall.push_back(0);
      walls.friction.push_back(friction);
      walls.velocity.push_back(Vec<Dim>::Zero());
    }
    find_wet_walls<Dim>(set.pairs(), set.particles, kernel_value(set.neighbourhood.kernel(), 0.0), fluid_weight,
                        is_wet);
  }

  static Particles<Dim> particles() {
    std::array<int, Dim> count;
    count.fill(7);
    Vec<Dim> low = Vec<Dim>::Constant(0.5 * dx);
    std::vector<Vec<Dim>> points = lattice_points<Dim>(low, count, dx);
    const std::size_t fluid_count = points.size();
    count[1] = 2;
    low[1] = -1.5 * dx;
    const auto wall = lattice_points<Dim>(low, count, dx);
    points.insert(points.end(), wall.begin(), wall.end());
    points.push_back(Vec<Dim>::Constant(-9.0));
    Particles<Dim> all = fluid_at<Dim>(points, dx);
    for (std::size_t i = fluid_count; i < all.owned; ++i) {
      all.kind[i] = ParticleKind::wall;
      all.wall_row[i] = static_cast<std::int32_t>(i - fluid_count);
    }
    return all;
  }

  std::vector<Vec<Dim>> with_walls(std::vector<Vec<Dim>> velocity) {
    set_wall_velocity<Dim>(set.pairs(), set.particles, walls, fluid_weight, is_wet, walls.velocity, mean, velocity);
    return velocity;
  }

  ParticleSet<Dim> set;
  WallModel<Dim> walls;
  std::vector<double> fluid_weight;
  std::vector<std::uint8_t> is_wet;
  std::vector<Vec<Dim>> mean;
};

template <int Dim>
Mat<Dim> flat() {
  return Vec<Dim>::UnitY() * Vec<Dim>::UnitY().transpose();
}

template <int Dim>
Vec<Dim> some_velocity() {
  Vec<Dim> u = Vec<Dim>::Constant(0.4);
  u[0] = 1.3;
  u[1] = -0.7;
  return u;
}

TYPED_TEST(WallTest, OnlyWallsInReachOfFluidAreWet) {
  constexpr int Dim = TypeParam::value;
  const WettedWall<Dim> wall(flat<Dim>(), 0.0, WallTreatment::dummies);
  for (std::size_t i = 0; i < wall.set.size(); ++i) {
    const bool is_last = i + 1 == wall.set.size();
    EXPECT_EQ(wall.is_wet[i] != 0, !wall.set.particles.is_fluid(i) && !is_last);
  }
}

TYPED_TEST(WallTest, AWallThatMovesWithTheWaterLeavesItAlone) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> u = some_velocity<Dim>();
  for (const WallTreatment treatment : {WallTreatment::dummies, WallTreatment::pressure_rows}) {
    WettedWall<Dim> wall(flat<Dim>(), 1.0, treatment);
    for (Vec<Dim>& V : wall.walls.velocity) V = u;
    const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
    std::vector<Vec<Dim>> acceleration(wall.set.size(), Vec<Dim>::Zero());
    add_wall_friction<Dim>(wall.set.pairs(), wall.set.particles, wall.walls, ViscosityLaw{.molecular = 1.0}, dx,
                           velocity, wall.mean, acceleration);
    for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
      EXPECT_LT((velocity[i] - u).norm(), 400.0 * eps);
      EXPECT_LT(acceleration[i].norm(), 4000.0 * eps / (dx * dx));
    }
    // A piston faster than the water: the image is as much faster again.
    for (Vec<Dim>& V : wall.walls.velocity) V = u + Vec<Dim>::UnitY();
    const auto pushed = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
    const double factor = treatment == WallTreatment::dummies ? 2.0 : 1.0;
    for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
      if (wall.set.particles.is_fluid(i)) continue;
      EXPECT_LT((pushed[i] - u - factor * Vec<Dim>::UnitY()).norm(), 400.0 * eps);
    }
  }
}

TYPED_TEST(WallTest, MirrorsAUniformVelocity) {
  constexpr int Dim = TypeParam::value;
  // The Shepard mean of a uniform velocity is that velocity, so each slip has a closed answer.
  const Vec<Dim> u = some_velocity<Dim>();
  const Vec<Dim> normal = u[1] * Vec<Dim>::UnitY();
  const Vec<Dim> tangential = u - normal;
  for (const double friction : {0.0, 0.3, 1.0}) {
    for (const bool is_corner : {false, true}) {
      for (const WallTreatment treatment : {WallTreatment::dummies, WallTreatment::pressure_rows}) {
        const Mat<Dim> blocked = is_corner ? Mat<Dim>(Mat<Dim>::Identity()) : flat<Dim>();
        WettedWall<Dim> wall(blocked, friction, treatment);
        const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
        Vec<Dim> expected;
        if (treatment == WallTreatment::dummies) {
          expected = is_corner ? Vec<Dim>(-u) : Vec<Dim>(tangential - normal);
        } else {
          expected = is_corner ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>((1.0 - friction) * tangential);
        }
        for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
          if (wall.set.particles.is_fluid(i)) {
            ASSERT_EQ(velocity[i], u);
          } else {
            ASSERT_LT((velocity[i] - expected).norm(), 400.0 * eps);  // a sum over a row
            ASSERT_LT((wall.mean[i] - u).norm(), 400.0 * eps);
          }
        }
        EXPECT_EQ(velocity.back(), Vec<Dim>(Vec<Dim>::Zero()));  // dry
      }
    }
  }
}

constexpr ViscosityLaw wall_law{.molecular = 0.1, .wall_distance = 0.6 * dx};

template <int Dim>
std::vector<Vec<Dim>> friction_acceleration(double friction, const std::vector<Vec<Dim>>& fluid_velocity,
                                            const ViscosityLaw& law) {
  WettedWall<Dim> wall(flat<Dim>(), friction, WallTreatment::dummies);
  const auto velocity = wall.with_walls(fluid_velocity);
  std::vector<Vec<Dim>> acceleration(wall.set.size(), Vec<Dim>::Zero());
  add_wall_friction<Dim>(wall.set.pairs(), wall.set.particles, wall.walls, law, dx, velocity, wall.mean, acceleration);
  return acceleration;
}

TYPED_TEST(WallTest, FrictionIsItsShareOfTheNoSlipStressAndTangential) {
  constexpr int Dim = TypeParam::value;
  const WettedWall<Dim> wall(flat<Dim>(), 0.0, WallTreatment::dummies);
  const std::vector<Vec<Dim>> uniform(wall.set.size(), some_velocity<Dim>());
  const auto free = friction_acceleration<Dim>(0.0, uniform, wall_law);
  const auto partial = friction_acceleration<Dim>(0.3, uniform, wall_law);
  const auto no_slip = friction_acceleration<Dim>(1.0, uniform, wall_law);
  Vec<Dim> tangential = some_velocity<Dim>();
  tangential[1] = 0.0;
  const double scale = 0.1 * tangential.norm() / (dx * dx);
  for (std::size_t i = 0; i < wall.set.size(); ++i) {
    EXPECT_EQ(free[i], Vec<Dim>(Vec<Dim>::Zero()));
    if (!wall.set.particles.is_fluid(i)) continue;
    EXPECT_LT((partial[i] - 0.3 * no_slip[i]).norm(), 400.0 * eps * scale);
    EXPECT_EQ(no_slip[i][1], 0.0);
    if (wall.set.position(i)[1] < dx) {
      // Against the flow, and along it only.
      EXPECT_LT(no_slip[i].dot(tangential), 0.0);
      EXPECT_NEAR(no_slip[i].dot(tangential), -no_slip[i].norm() * tangential.norm(), 400.0 * eps * scale);
    }
    if (wall.set.position(i)[1] > 3.0 * dx) {
      EXPECT_EQ(no_slip[i], Vec<Dim>(Vec<Dim>::Zero()));
    }
  }
}

TYPED_TEST(WallTest, FrictionGoesByTheWallsViscosityAlone) {
  constexpr int Dim = TypeParam::value;
  const WettedWall<Dim> wall(flat<Dim>(), 0.0, WallTreatment::dummies);
  const std::vector<Vec<Dim>> uniform(wall.set.size(), some_velocity<Dim>());
  const auto laminar = friction_acceleration<Dim>(1.0, uniform, wall_law);
  const ViscosityLaw water{.molecular = 1e-6, .artificial = 0.2 * dx, .floor = 0.3, .wall_distance = 0.6 * dx};
  const auto turbulent = friction_acceleration<Dim>(1.0, uniform, water);
  const double ratio = water.at_wall(some_velocity<Dim>().norm()) / wall_law.at_wall(some_velocity<Dim>().norm());
  for (std::size_t i = 0; i < wall.set.size(); ++i) {
    EXPECT_LE((turbulent[i] - ratio * laminar[i]).norm(), 8.0 * eps * turbulent[i].norm());
  }
}

TEST(WallLaw, StressOfWernerAndWengle) {
  const double nu = 1e-6;
  const double y = 0.012;
  const ViscosityLaw law{.molecular = nu, .artificial = 1.0, .floor = 1.0, .wall_distance = y};
  for (const double u_tau : {0.01, 0.1, 1.0}) {  // y+ of 120 to 12000: turbulent
    const double speed = 8.3 * u_tau * std::pow(y * u_tau / nu, 1.0 / 7.0);
    EXPECT_NEAR(law.at_wall(speed) * speed / y, u_tau * u_tau, 16.0 * eps * u_tau * u_tau);
  }
  EXPECT_EQ(law.at_wall(0.0), nu);
  EXPECT_EQ(law.at_wall(139.0 * nu / y), nu);  // laminar up to u y/nu = 8.3^(7/3) = 139.5
  const double transition = std::pow(8.3, 7.0 / 3.0) * nu / y;
  EXPECT_NEAR(law.at_wall(transition * (1.0 + 1e-9)), nu, 1e-9 * nu);  // continuous
  EXPECT_EQ((ViscosityLaw{.wall_distance = y}.at_wall(3.0)), 0.0);
}

TEST(SideWalls, StressIsTheMeanOfThePowerLawOverHalfTheWidth) {
  const double nu = 1e-6;
  const double b = 0.3;
  const ViscosityLaw law{.molecular = nu, .wall_distance = 0.012, .channel_width = b};
  for (const double u_tau : {0.01, 0.1}) {
    // The mean of 8.3 u_tau (y u_tau/nu)^(1/7) over y = 0 .. b/2 is 7/8 of its value at b/2.
    const double speed = 7.0 / 8.0 * 8.3 * u_tau * std::pow(0.5 * b * u_tau / nu, 1.0 / 7.0);
    EXPECT_NEAR(law.side_wall_rate(speed) * speed, 2.0 * u_tau * u_tau / b, 64.0 * eps * u_tau * u_tau / b);
  }
  // Slow water: the two walls of plane Poiseuille flow, whose pressure gradient is 12 nu u/b^2.
  EXPECT_DOUBLE_EQ(law.side_wall_rate(1e-9), 12.0 * nu / (b * b));
  EXPECT_EQ((ViscosityLaw{.molecular = nu}.side_wall_rate(3.0)), 0.0);
}

TYPED_TEST(WallTest, SideWallsSlowFluidAgainstItsVelocityOnly) {
  constexpr int Dim = TypeParam::value;
  const WettedWall<Dim> wall(flat<Dim>(), 0.0, WallTreatment::dummies);
  const std::vector<Vec<Dim>> velocity(wall.set.size(), some_velocity<Dim>());
  const ViscosityLaw law{.molecular = 1e-6, .wall_distance = 0.6 * dx, .channel_width = 0.3};
  std::vector<Vec<Dim>> acceleration(wall.set.size(), Vec<Dim>::Zero());
  add_side_wall_friction<Dim>(wall.set.particles, law, velocity, acceleration);
  const Vec<Dim> expected = -law.side_wall_rate(some_velocity<Dim>().norm()) * some_velocity<Dim>();
  for (std::size_t i = 0; i < wall.set.size(); ++i) {
    EXPECT_EQ(acceleration[i], wall.set.particles.is_fluid(i) ? expected : Vec<Dim>(Vec<Dim>::Zero()));
  }
}

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
  WallWays<2> ways{.way = std::vector<AffineMap<2>>(1), .dt = dt};
  ways.way[0].constant = Vec<2>(way, 0.0);
  EXPECT_EQ(
      keep_off_walls<2>(moving.pairs, moving.boundary, dx, ways, start, moving.particles, moving.particles.velocity),
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

}  // namespace
}  // namespace tailwater
