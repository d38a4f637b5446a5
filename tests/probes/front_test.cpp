#include "probes/front.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "probes/tank.h"

namespace tailwater {
namespace {

template <class Dimension>
class FrontTest : public testing::Test {
 public:
  static constexpr int dimension = Dimension::value;
  using TankOf = Tank<dimension>;

  static Row front(const TankOf& tank, const Coordinates& direction = {}) {
    ProbeTable probe;
    probe.name = "test";
    probe.type = ProbeType::front;
    probe.direction = direction;
    return front_reading<dimension>(probe).take(tank.context()).at(0);
  }
  static TankOf column() {
    return TankOf(0.4, [](const Vec<dimension>& x) { return x[0] < 0.3 && x[dimension - 1] < 0.4; });
  }
};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(FrontTest, Dimensions);

TYPED_TEST(FrontTest, IsTheEdgeOfTheBlock) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  const T tank = TestFixture::column();
  EXPECT_NEAR(TestFixture::front(tank)[0], 0.3, 1e-12);
  EXPECT_NEAR(TestFixture::front(tank)[1], 0.3, 1e-12);
  Coordinates up(dim, 0.0);
  up.back() = 2.0;  // only its direction counts
  EXPECT_NEAR(TestFixture::front(tank, up)[0], 0.4, 1e-12);
  Coordinates left(dim, 0.0);
  left.front() = -1.0;
  EXPECT_NEAR(TestFixture::front(tank, left)[0], 0.0, 1e-12);
}

TYPED_TEST(FrontTest, SprayAheadIsNotConnected) {
  using T = typename TestFixture::TankOf;
  constexpr int dim = TestFixture::dimension;
  T tank = TestFixture::column();
  // Drops, each within the support of all others but one neighbour short of being connected.
  constexpr int drops = dim == 2 ? 5 : 25;
  constexpr double step = 0.02;
  for (int k = 0; k < drops; ++k) {
    Vec<dim> x = Vec<dim>::Constant(0.5);
    x[0] = 0.7 + step * k * T::dx;
    tank.add(x, true, 0.0);
  }
  tank.locate();
  const double edge = 0.7 + (step * (drops - 1) + 0.5) * T::dx;
  EXPECT_NEAR(TestFixture::front(tank)[0], edge, 1e-12);
  EXPECT_NEAR(TestFixture::front(tank)[1], 0.3, 1e-12);
  // One more drop behind them makes up the number.
  Vec<dim> x = Vec<dim>::Constant(0.5);
  x[0] = 0.7 - step * T::dx;
  tank.add(x, true, 0.0);
  tank.locate();
  EXPECT_NEAR(TestFixture::front(tank)[1], edge, 1e-12);
}

TYPED_TEST(FrontTest, NoFluidReadsZero) {
  using T = typename TestFixture::TankOf;
  EXPECT_EQ(TestFixture::front(T::filled(0.0)), (Row{0.0, 0.0}));
}

TYPED_TEST(FrontTest, RefusesADirectionWithoutLength) {
  EXPECT_THROW(TestFixture::front(TestFixture::column(), Coordinates(TestFixture::dimension, 0.0)), InputError);
}

}  // namespace
}  // namespace tailwater
