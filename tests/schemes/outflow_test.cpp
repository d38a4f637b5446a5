// Water that has fallen below all walls is no longer computed: nothing brings it back, and in free fall it would
// shorten the steps of all water for ever.
#include <gtest/gtest.h>

#include <vector>

#include "flow/saved_flow.h"
#include "parts/domain_floor.h"
#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace outflow_test {

constexpr double dx = 0.1;

template <class D>
class OutflowTest : public testing::Test {};
TYPED_TEST_SUITE(OutflowTest, Dimensions);

/// A place left of the tank, so far below its bed.
template <int Dim>
Vec<Dim> beside(double below) {
  Vec<Dim> x = Vec<Dim>::Constant(-1.0);
  x[Dim - 1] = -below;
  return x;
}

TYPED_TEST(OutflowTest, WaterASupportBelowAllWallsIsBookedAndGone) {
  constexpr int Dim = TypeParam::value;
  const CaseSpec spec = tank_case<Dim>(dx, 0.4, 0.2);
  Flow<Dim> flow = make_flow<Dim>(spec);
  Particles<Dim>& particles = flow.state.particles;
  const double support = kernel_radius(flow.setup.scale.kernel);
  const std::size_t owned = particles.owned;
  const double energy = measure(flow).energy();
  EXPECT_FALSE(remove_outflow(flow));

  particles.position[0] = beside<Dim>(0.99 * support);  // may still be under the spray of others
  particles.position[1] = beside<Dim>(1.01 * support);
  particles.velocity[1] = Vec<Dim>::Constant(2.0);
  const std::int64_t stays = particles.id[0];
  const std::int64_t falls = particles.id[1];
  const double volume = particles.volume[1];
  const double taken = flow.kinetic_energy_of(1) + flow.potential_energy_of(1);
  const double with_it = measure(flow).energy();
  ASSERT_NE(with_it, energy);

  EXPECT_TRUE(remove_outflow(flow));
  ASSERT_EQ(particles.owned, owned - 1);
  for (std::size_t i = 0; i < particles.owned; ++i) EXPECT_NE(particles.id[i], falls);
  EXPECT_EQ(particles.id[0], stays);
  EXPECT_EQ(flow.template part<DomainFloor<Dim>>().fallen().particles, 1);
  EXPECT_EQ(flow.template part<DomainFloor<Dim>>().fallen().volume, volume);
  EXPECT_DOUBLE_EQ(flow.template part<DomainFloor<Dim>>().fallen().energy, taken);
  const FlowMeasures measures = measure(flow);
  EXPECT_EQ(measures.departed.particles, 1);
  EXPECT_NEAR(measures.energy() + measures.departed.energy, with_it, 1e-12 * std::abs(with_it));
  EXPECT_FALSE(remove_outflow(flow));

  Flow<Dim> resumed = make_flow<Dim>(spec);
  SavedFlow<Dim> saved;
  flow.save(saved);
  ASSERT_TRUE(resumed.restore(std::move(saved)));
  const WaterAmount& restored = resumed.template part<DomainFloor<Dim>>().fallen();
  EXPECT_EQ(restored.particles, 1);
  EXPECT_EQ(restored.volume, volume);
  EXPECT_EQ(restored.energy, flow.template part<DomainFloor<Dim>>().fallen().energy);
}

TYPED_TEST(OutflowTest, WithoutGravityNothingFalls) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = tank_case<Dim>(dx, 0.4, 0.2);
  spec.physics.gravity = Coordinates(Dim, 0.0);
  spec.study.length = 0.2;
  Flow<Dim> flow = make_flow<Dim>(spec);
  flow.state.particles.position[0] = beside<Dim>(100.0);
  EXPECT_FALSE(remove_outflow(flow));
  EXPECT_EQ(flow.template part<DomainFloor<Dim>>().fallen().particles, 0);
}

}  // namespace outflow_test
}  // namespace tailwater
