#include "run/failure.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/dimensions.h"
#include "support/pond.h"

namespace tailwater {
namespace {

template <class Dimension>
class FindNonFinite : public testing::Test {
 protected:
  static constexpr int Dim = Dimension::value;
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  Flow<Dim> flow = make_flow<Dim>(pond_case<Dim>());
};

TYPED_TEST_SUITE(FindNonFinite, Dimensions);

TYPED_TEST(FindNonFinite, FindsNothingInStillWater) { EXPECT_EQ(find_non_finite(this->flow), std::nullopt); }

TYPED_TEST(FindNonFinite, FindsTheFirstParticleByAnyOfItsFields) {
  auto& water = this->flow;
  constexpr int last = TestFixture::Dim - 1;
  water.state.particles.pressure[7] = this->nan;
  EXPECT_EQ(find_non_finite(water), 7u);
  water.state.particles.velocity[5][last] = -this->infinite;
  EXPECT_EQ(find_non_finite(water), 5u);
  water.state.particles.position[3][0] = this->infinite;
  EXPECT_EQ(find_non_finite(water), 3u);
}

TYPED_TEST(FindNonFinite, LooksAtTheWaterOnly) {
  this->flow.state.particles.kind[4] = ParticleKind::wall;
  this->flow.state.particles.pressure[4] = this->nan;
  EXPECT_EQ(find_non_finite(this->flow), std::nullopt);
}

}  // namespace
}  // namespace tailwater
