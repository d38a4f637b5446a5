// The velocities that the wall rows of the papers present to the water.
#include <gtest/gtest.h>

#include "published/pressure_rows.h"
#include "published/row_and_dummies.h"
#include "support/dimensions.h"
#include "support/rounding.h"
#include "support/wetted_wall.h"

namespace tailwater {
namespace {

template <class D>
class WallRowsTest : public testing::Test {};
TYPED_TEST_SUITE(WallRowsTest, Dimensions);

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make(bool with_dummies) {
  return with_dummies ? make_row_and_dummies<Dim>() : make_pressure_rows<Dim>(std::make_shared<Tensors<Dim>>());
}

TYPED_TEST(WallRowsTest, AWallThatMovesWithTheWaterLeavesItAlone) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> u = some_velocity<Dim>();
  for (const bool with_dummies : {false, true}) {
    WettedWall<Dim> wall(flat<Dim>(), 1.0, make<Dim>(with_dummies));
    for (Vec<Dim>& V : wall.V) V = u;
    const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
    const auto acceleration = wall.friction_acceleration(friction_law<Dim>(1.0), velocity);
    for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
      EXPECT_LT((velocity[i] - u).norm(), 4.0 * single_eps);
      EXPECT_LT(acceleration[i].norm(), 40.0 * single_eps / (wetted_dx * wetted_dx));
    }
    // A piston faster than the water: the rows have the velocity of the piston.
    for (Vec<Dim>& V : wall.V) V = u + Vec<Dim>::UnitY();
    const auto pushed = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
    for (std::size_t i = 0; i + 1 < wall.set.size(); ++i) {
      if (wall.set.particles.is_fluid(i)) continue;
      EXPECT_LT((pushed[i] - u - Vec<Dim>::UnitY()).norm(), 4.0 * single_eps);
    }
  }
}

TYPED_TEST(WallRowsTest, ShowWhatSlipLeavesOfAUniformVelocity) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> u = some_velocity<Dim>();
  const Vec<Dim> tangential = u - u[1] * Vec<Dim>::UnitY();
  for (const double friction : {0.0, 0.3, 1.0}) {
    for (const bool is_corner : {false, true}) {
      for (const bool with_dummies : {false, true}) {
        const Mat<Dim> blocked = is_corner ? Mat<Dim>(Mat<Dim>::Identity()) : flat<Dim>();
        WettedWall<Dim> wall(blocked, friction, make<Dim>(with_dummies));
        const auto velocity = wall.with_walls(std::vector<Vec<Dim>>(wall.set.size(), u));
        const Vec<Dim> expected = is_corner ? Vec<Dim>(Vec<Dim>::Zero()) : Vec<Dim>((1.0 - friction) * tangential);
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
}

}  // namespace
}  // namespace tailwater
