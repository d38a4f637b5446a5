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
    set_wall_velocity<Dim>(set.pairs(), set.particles, walls, fluid_weight, is_wet, mean, velocity);
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
          expected = is_corner ? Vec<Dim>(-u) : Vec<Dim>((1.0 - 2.0 * friction) * tangential - normal);
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

template <int Dim>
std::vector<Vec<Dim>> viscous_acceleration(double friction, const std::vector<Vec<Dim>>& fluid_velocity) {
  WettedWall<Dim> wall(flat<Dim>(), friction, WallTreatment::dummies);
  const auto velocity = wall.with_walls(fluid_velocity);
  std::vector<Vec<Dim>> acceleration(wall.set.size(), Vec<Dim>::Zero());
  add_morris_viscosity<Dim>(wall.set.pairs(), wall.set.particles, wall.walls, dx,
                            std::vector<double>(wall.set.size(), 0.1), velocity, wall.mean, acceleration);
  return acceleration;
}

TYPED_TEST(WallTest, FrictionIsItsShareOfTheNoSlipStressAndTangential) {
  constexpr int Dim = TypeParam::value;
  const WettedWall<Dim> wall(flat<Dim>(), 0.0, WallTreatment::dummies);
  const std::vector<Vec<Dim>> uniform(wall.set.size(), some_velocity<Dim>());
  const auto free = viscous_acceleration<Dim>(0.0, uniform);
  const auto partial = viscous_acceleration<Dim>(0.3, uniform);
  const auto no_slip = viscous_acceleration<Dim>(1.0, uniform);
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

TEST(WallContact, PutsParticlesBackAndTakesOnlyTheVelocityIntoTheWall) {
  // Floor y = 0 and a wall x = 0 meet in the origin; the fluid is in the first quadrant.
  Boundary<2> boundary;
  boundary.walls.push_back({"wall", 0.0});
  boundary.faces.push_back({{Vec<2>(0.0, 5.0), Vec<2>(0.0, 0.0)}, Vec<2>(1.0, 0.0), 0});
  boundary.faces.push_back({{Vec<2>(0.0, 0.0), Vec<2>(5.0, 0.0)}, Vec<2>(0.0, 1.0), 0});

  const Vec<2> into(-1.0, -2.0);
  const std::vector<Vec<2>> positions{{1.0, -0.02},   {1.0, 0.02},  {3.0, 0.004},
                                      {-0.02, -0.01}, {4.0, -0.05}, {2.0, -0.1}};
  Particles<2> particles = fluid_at<2>(positions, dx);
  for (Vec<2>& velocity : particles.velocity) velocity = into;
  particles.velocity[4] = Vec<2>(0.5, 1.0);  // behind the floor but leaving it
  particles.kind[5] = ParticleKind::wall;
  // Each has a wall particle among its neighbours.
  Pairs<2> pairs;
  pairs.row_begin = {0};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    pairs.j.push_back(5);
    pairs.row_begin.push_back(pairs.j.size());
  }
  const double least = 0.05 * dx;
  EXPECT_EQ(keep_off_walls<2>(pairs, boundary, dx, particles), 4u);
  EXPECT_LT((particles.position[0] - Vec<2>(1.0, least)).norm(), 4.0 * eps);
  EXPECT_EQ(particles.velocity[0], Vec<2>(-1.0, 0.0));
  EXPECT_EQ(particles.position[1], positions[1]);
  EXPECT_EQ(particles.velocity[1], into);
  EXPECT_LT((particles.position[2] - Vec<2>(3.0, least)).norm(), 4.0 * eps);
  EXPECT_LT((particles.position[3] - Vec<2>(least, least)).norm(), 4.0 * eps);
  EXPECT_EQ(particles.velocity[3], Vec<2>(0.0, 0.0));
  EXPECT_EQ(particles.velocity[4], Vec<2>(0.5, 1.0));
  EXPECT_EQ(particles.position[5], positions[5]);  // walls stay
}

}  // namespace
}  // namespace tailwater
