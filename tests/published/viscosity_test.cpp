#include "published/viscosity.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/dimensions.h"
#include "support/tensors.h"

namespace tailwater {
namespace viscosity_test {

constexpr double dx = 0.1;

template <class D>
class PublishedViscosityTest : public testing::Test {};
TYPED_TEST_SUITE(PublishedViscosityTest, Dimensions);

TYPED_TEST(PublishedViscosityTest, LeavesAUniformVelocityAlone) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  const ConsistentOperators<Dim> operators(set);
  const auto velocity = sample(set, [](const Vec<Dim>&) { return Vec<Dim>(Vec<Dim>::Constant(1.7)); });
  const std::vector<double> viscosity(set.size(), 0.1);
  std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
  add_consistent_viscosity<Dim>(set.pairs(), set.particles, operators.tensors, operators.takes_part, dx, viscosity,
                                velocity, acceleration);
  for (const Vec<Dim>& a : acceleration) EXPECT_EQ(a, Vec<Dim>(Vec<Dim>::Zero()));
}

TYPED_TEST(PublishedViscosityTest, ConsistentFormIsExactForQuadraticVelocities) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  const ConsistentOperators<Dim> operators(set);
  // Poiseuille: u = y^2 in x, lap u = 2; the other parts linear.
  const auto velocity = sample(set, [](const Vec<Dim>& x) {
    Vec<Dim> u = 3.0 * x;
    u[0] = x[1] * x[1];
    return u;
  });
  const double nu = 0.05;
  std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
  add_consistent_viscosity<Dim>(set.pairs(), set.particles, operators.tensors, operators.takes_part, dx,
                                std::vector<double>(set.size(), nu), velocity, acceleration);
  std::size_t tested = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!operators.tensors[i].laplacian_is_sound()) continue;
    ++tested;
    // Round-off of the exact row, as in tests/operators: 1e3 (condition of B2) x eps x |c_ij| of order 1e3/m^2.
    EXPECT_LT((acceleration[i] - 2.0 * nu * Vec<Dim>::UnitX()).norm(), 1e-9 * nu);
  }
  EXPECT_GT(tested, 0u);
}

}  // namespace viscosity_test
}  // namespace tailwater
