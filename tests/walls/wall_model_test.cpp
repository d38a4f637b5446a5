// Velocities that wall models present to the water, and wall friction.
#include "walls/wall_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "closures/wall_law.h"
#include "support/dimensions.h"
#include "support/rounding.h"
#include "support/wetted_wall.h"
#include "walls/dummies.h"

namespace tailwater {
namespace wall_model_test {

template <class D>
class WallTest : public testing::Test {};
TYPED_TEST_SUITE(WallTest, Dimensions);

TYPED_TEST(WallTest, OnlyWallsInReachOfFluidAreWet) {
  constexpr int Dim = TypeParam::value;
  const WettedWall<Dim> wall(flat<Dim>(), 0.0, make_dummies<Dim>());
  for (std::size_t i = 0; i < wall.set.size(); ++i) {
    const bool is_last = i + 1 == wall.set.size();
    EXPECT_EQ(wall.surroundings.is_wet[i] != 0, !wall.set.particles.is_fluid(i) && !is_last);
  }
}

TYPED_TEST(WallTest, AWallThatMovesWithTheWaterLeavesItAlone) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> u = some_velocity<Dim>();
  WettedWall<Dim> wall(flat<Dim>(), 1.0, make_dummies<Dim>());
  for (Vec<Dim>& V : wall.V) V = u;
  const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
  const auto acceleration = wall.friction_acceleration(friction_law<Dim>(1.0), velocity);
  for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
    EXPECT_LT((velocity[i] - u).norm(), 4.0 * single_eps);
    EXPECT_LT(acceleration[i].norm(), 40.0 * single_eps / (wetted_dx * wetted_dx));
  }
  // A piston faster than the water: the velocity of the image exceeds that of the piston by the same amount.
  for (Vec<Dim>& V : wall.V) V = u + Vec<Dim>::UnitY();
  const auto pushed = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
  for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
    if (wall.set.particles.is_fluid(i)) continue;
    EXPECT_LT((pushed[i] - u - 2.0 * Vec<Dim>::UnitY()).norm(), 4.0 * single_eps);
  }
}

TYPED_TEST(WallTest, MirrorsAUniformVelocity) {
  constexpr int Dim = TypeParam::value;
  // The Shepard mean of a uniform velocity is that velocity, so each slip has a closed-form result.
  const Vec<Dim> u = some_velocity<Dim>();
  const Vec<Dim> normal = u[1] * Vec<Dim>::UnitY();
  const Vec<Dim> tangential = u - normal;
  for (const double friction : {0.0, 0.3, 1.0}) {
    for (const bool is_corner : {false, true}) {
      const Mat<Dim> blocked = is_corner ? Mat<Dim>(Mat<Dim>::Identity()) : flat<Dim>();
      WettedWall<Dim> wall(blocked, friction, make_dummies<Dim>());
      const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
      const Vec<Dim> expected = is_corner ? Vec<Dim>(-u) : Vec<Dim>(tangential - normal);
      for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
        if (wall.set.particles.is_fluid(i)) {
          ASSERT_EQ(velocity[i], u);
        } else {
          ASSERT_LT((velocity[i] - expected).norm(), 4.0 * single_eps);
        }
      }
      EXPECT_EQ(velocity.back(), Vec<Dim>(Vec<Dim>::Zero()));  // dry
    }
  }
}

constexpr double viscous = 0.1;  // laminar
constexpr double water = 1e-6;   // turbulent

template <int Dim>
std::vector<Vec<Dim>> friction_acceleration(double friction, const std::vector<Vec<Dim>>& fluid_velocity,
                                            const FrictionLaw& law) {
  WettedWall<Dim> wall(flat<Dim>(), friction, make_dummies<Dim>());
  return wall.friction_acceleration(law, wall.with_walls(fluid_velocity));
}

TYPED_TEST(WallTest, FrictionIsItsShareOfTheNoSlipStressAndTangential) {
  constexpr int Dim = TypeParam::value;
  const WettedWall<Dim> wall(flat<Dim>(), 0.0, make_dummies<Dim>());
  const std::vector<Vec<Dim>> uniform(wall.set.size(), some_velocity<Dim>());
  Vec<Dim> tangential = some_velocity<Dim>();
  tangential[1] = 0.0;
  for (const double viscosity : {viscous, water}) {
    const FrictionLaw law = friction_law<Dim>(viscosity);
    const auto free = friction_acceleration<Dim>(0.0, uniform, law);
    const auto partial = friction_acceleration<Dim>(0.3, uniform, law);
    const auto no_slip = friction_acceleration<Dim>(1.0, uniform, law);
    const double scale = 0.1 * tangential.norm() / (wetted_dx * wetted_dx);
    for (std::size_t i = 0; i < wall.set.size(); ++i) {
      EXPECT_EQ(free[i], Vec<Dim>(Vec<Dim>::Zero()));
      if (!wall.set.particles.is_fluid(i)) continue;
      EXPECT_LT((partial[i] - 0.3 * no_slip[i]).norm(), 400.0 * eps * scale);
      EXPECT_EQ(no_slip[i][1], 0.0);
      if (wall.set.position(i)[1] < wetted_dx) {
        // Against the flow, and along it only.
        EXPECT_LT(no_slip[i].dot(tangential), 0.0);
        EXPECT_NEAR(no_slip[i].dot(tangential), -no_slip[i].norm() * tangential.norm(), 400.0 * eps * scale);
      }
      if (wall.set.position(i)[1] > 3.0 * wetted_dx) {
        EXPECT_EQ(no_slip[i], Vec<Dim>(Vec<Dim>::Zero()));
      }
    }
  }
}

/// The stress over rho [m^2/s^2] on the middle of the wall: the momentum that the column above loses per time and area.
template <int Dim>
double stress_in_the_middle(const WettedWall<Dim>& wall, const std::vector<Vec<Dim>>& acceleration) {
  const Vec<Dim> middle = Vec<Dim>::Constant(3.5 * wetted_dx);
  double sum = 0.0;
  for (std::size_t i = 0; i < wall.set.size(); ++i) {
    Vec<Dim> away = wall.set.position(i) - middle;
    away[1] = 0.0;
    if (away.norm() < 0.1 * wetted_dx) sum -= acceleration[i][0] * wetted_dx;
  }
  return sum;
}

TYPED_TEST(WallTest, ALogarithmicProfileGetsItsStress) {
  constexpr int Dim = TypeParam::value;
  const double u_tau = 0.05;
  for (const double roughness : {0.0, 0.003}) {
    WettedWall<Dim> wall(flat<Dim>(), 1.0, make_dummies<Dim>());
    std::ranges::fill(wall.walls.roughness, roughness);
    const WallLaw law{water, roughness};
    std::vector<Vec<Dim>> velocity(wall.set.size(), Vec<Dim>::Zero());
    for (std::size_t i = 0; i < wall.set.size(); ++i) {
      if (!wall.set.particles.is_fluid(i)) continue;
      velocity[i][0] = u_tau / von_karman * std::log1p(wall.set.position(i)[1] / law.zero_height(u_tau));
    }
    const auto acceleration = wall.friction_acceleration(friction_law<Dim>(water), wall.with_walls(velocity));
    // Every particle has the same u_tau. The laminar stress, which is subtracted as u/y and added as the two-point sum,
    // is below nu u/y = 3e-5 of u_tau^2. The walls' third row, which the set omits, has no weight.
    EXPECT_NEAR(stress_in_the_middle(wall, acceleration), u_tau * u_tau, 1e-3 * u_tau * u_tau);
  }
}

TYPED_TEST(WallTest, AThinLayerRubsMoreAndAThickOneAsIfItWereNotKnown) {
  constexpr int Dim = TypeParam::value;
  WettedWall<Dim> wall(flat<Dim>(), 1.0, make_dummies<Dim>());
  const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), some_velocity<Dim>()));
  const double unknown = stress_in_the_middle(wall, wall.friction_acceleration(friction_law<Dim>(water), velocity));
  FrictionLaw knowing = friction_law<Dim>(water);
  knowing.knows_layers = true;
  double before = std::numeric_limits<double>::infinity();
  for (const double layer_viscosity : {0.0, 1e-5, 1e-4, 1e-3}) {
    std::ranges::fill(wall.set.particles.layer_viscosity, layer_viscosity);
    const double stress = stress_in_the_middle(wall, wall.friction_acceleration(knowing, velocity));
    EXPECT_LT(stress, before);
    before = stress;
  }
  std::ranges::fill(wall.set.particles.layer_viscosity, 1.0);
  EXPECT_EQ(stress_in_the_middle(wall, wall.friction_acceleration(knowing, velocity)), unknown);
}

TYPED_TEST(WallTest, WallsFeelTheOppositeOfTheirFriction) {
  constexpr int Dim = TypeParam::value;
  for (const double viscosity : {viscous, water}) {
    const FrictionLaw law = friction_law<Dim>(viscosity);
    WettedWall<Dim> wall(flat<Dim>(), 1.0, make_dummies<Dim>());
    const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), some_velocity<Dim>()));
    std::vector<Vec<Dim>> no_slip(wall.set.size(), Vec<Dim>::Zero());
    std::vector<Vec<Dim>> acceleration(wall.set.size(), Vec<Dim>::Zero());
    std::vector<Vec<Dim>> force(wall.set.size(), Vec<Dim>::Zero());
    std::vector<double> excess_viscosity(wall.set.size());
    wall.model->find_no_slip_velocity(wall.scene(), wall.V, velocity, no_slip);
    add_wall_friction<Dim>(wall.scene(), law, wall.friction_walls(law, velocity), no_slip, velocity, acceleration,
                           excess_viscosity);
    find_friction_on_walls<Dim>(wall.scene(), law, wall.V, no_slip, velocity, excess_viscosity, force);
    Vec<Dim> sum = Vec<Dim>::Zero();
    double size = 0.0;
    for (std::size_t i = 0; i < wall.set.size(); ++i) {
      const Vec<Dim> on_water = wall.set.particles.volume[i] * acceleration[i];
      sum += on_water + force[i];
      size += on_water.norm();
    }
    EXPECT_GT(size, 0.0);
    EXPECT_LT(sum.norm(), 100.0 * eps * size);
  }
}

}  // namespace wall_model_test
}  // namespace tailwater
