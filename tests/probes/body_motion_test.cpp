#include "probes/body_motion.h"

#include <gtest/gtest.h>

#include "motion/floating_body.h"
#include "probes/tank.h"

namespace tailwater {
namespace {

template <class Dimension>
class RollingBody : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RollingBody, Dimensions);

// A body that rolls three times forwards, then once back: its angle never jumps.
TYPED_TEST(RollingBody, HasAnAngleWithItsWholeTurns) {
  constexpr int dim = TypeParam::value;
  Tank<dim> tank = Tank<dim>::filled(0.5);
  BodyTable body;
  body.name = "log";
  body.mass = 1.0;
  body.centre.assign(dim, 0.5);
  body.inertia.assign(turns<dim>, 1.0);
  body.velocity.assign(dim, 0.0);
  tank.spec.bodies = {body};
  ProbeTable probe;
  probe.type = ProbeType::motion;
  probe.body = "log";
  const Reading<dim> reading = motion_reading<dim>(probe, tank.spec);
  Turn<dim> axis = Turn<dim>::Ones();
  axis.normalize();
  std::vector<BodyState<dim>> states(1);
  states[0].centre = Vec<dim>::Constant(0.5);
  ProbeContext<dim> context = tank.context();
  const auto read_at = [&](double angle) {
    states[0].placement.linear = rotation_by<dim>(Turn<dim>(angle * axis));
    context.bodies = states;
    const Row row = reading.take(context).at(0);
    for (int k = 0; k < turns<dim>; ++k) EXPECT_NEAR(row[dim + k], angle * axis[k], 1e-9) << "angle " << angle;
  };
  for (int n = 0; n <= 60; ++n) read_at(0.3 * n);
  for (int n = 60; n >= 40; --n) read_at(0.3 * n);
  const std::vector<double> totals = reading.totals();
  EXPECT_NEAR(totals[2 * dim], 0.0, 1e-12);
  EXPECT_NEAR(totals[2 * dim + 1], 18.0 * axis[0], 1e-9);
}

}  // namespace
}  // namespace tailwater
