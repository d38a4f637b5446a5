// Growth of boundary layers at walls with friction.
#include <gtest/gtest.h>

#include <cmath>

#include "case/choices.h"
#include "case/spec.h"
#include "cases.h"
#include "closures/spalart_allmaras.h"
#include "closures/wall_law.h"
#include "parts/boundary_layers.h"
#include "published/make_flow.h"
#include "support/dimensions.h"

namespace tailwater {
namespace boundary_layer_test {

constexpr double dx = 0.01;

/// Water that moves uniformly at 1 m/s over a bed, 16 dx deep, periodic along the bed.
template <int Dim>
CaseSpec gliding_water(Slip slip) {
  constexpr double length = 8.0 * dx;
  constexpr double depth = 16.0 * dx;
  CaseSpec spec = tank_case<Dim>(dx, length, depth);
  spec.domain.periodic_x = {0.0, length};
  spec.walls[0].open = {"-x", "+x"};
  if (Dim == 3) {
    spec.domain.periodic_y = {0.0, length};
    spec.walls[0].open.insert(spec.walls[0].open.end(), {"-y", "+y"});
  }
  spec.walls[0].open.emplace_back(Dim == 2 ? "+y" : "+z");
  spec.walls[0].slip = slip;
  spec.fluid[0].velocity = VectorField(Dim, 0.0);
  spec.fluid[0].velocity[0] = 1.0;
  return spec;
}

template <class D>
class BoundaryLayerTest : public testing::Test {};
TYPED_TEST_SUITE(BoundaryLayerTest, Dimensions);

TYPED_TEST(BoundaryLayerTest, BeginsAtTheWallAndEndsWhereItHasNotCome) {
  constexpr int Dim = TypeParam::value;
  CaseSpec spec = gliding_water<Dim>(Slip::no_slip);
  spec.walls[0].roughness = 0.001;
  Flow<Dim> flow = make_flow<Dim>(spec);
  const int steps = Dim == 2 ? 100 : 30;
  double impulse = 0.0;
  for (int n = 0; n < steps; ++n) impulse += step(flow).dt;
  const Particles<Dim>& particles = flow.state.particles;
  double lost = 0.0;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    if (!particles.is_fluid(i)) continue;
    const double y = particles.position[i][Dim - 1];
    if (particles.layer_viscosity[i] > 0.0) {
      // Along pairs of particles the path to the wall is not straight: it is up to 4 % longer, in the worst direction
      // of a lattice.
      EXPECT_NEAR(particles.wall_distance[i], y, 0.05 * y + 0.1 * dx);
    }
    if (y < dx) {
      EXPECT_GT(particles.layer_viscosity[i], 0.0);
    }
    if (y > 8.0 * dx) {
      EXPECT_EQ(particles.layer_viscosity[i], 0.0);
    }
    lost += particles.volume[i] * (1.0 - particles.velocity[i][0]);
  }
  // The mean stress lies between that of a layer as thick as dx and that of one as thick as the roughness.
  const double area = std::pow(8.0 * dx, Dim - 1);
  const double stress = lost / (impulse * area);
  const WallLaw law{1e-6, 0.001};
  const auto stress_at = [&](double y) {
    return std::pow(law.turbulent_friction_velocity(1.0, [&](double) { return y; }), 2);
  };
  EXPECT_GT(stress, stress_at(dx));
  EXPECT_LT(stress, stress_at(0.001));
}

TYPED_TEST(BoundaryLayerTest, IsNotThereWithoutFrictionNorInLaminarFlow) {
  constexpr int Dim = TypeParam::value;
  for (const bool is_laminar : {false, true}) {
    CaseSpec spec = gliding_water<Dim>(is_laminar ? Slip::no_slip : Slip::free);
    if (is_laminar) spec.physics.viscosity = 1e-3;  // 1 m/s in dx/2: u y/nu = 5
    Flow<Dim> flow = make_flow<Dim>(spec);
    EXPECT_EQ(has_part<BoundaryLayers<Dim>>(flow), is_laminar);
    for (int n = 0; n < 5; ++n) step(flow);
    for (const double layer : flow.state.particles.layer_viscosity) EXPECT_EQ(layer, 0.0);
  }
}

TEST(BoundaryLayer, ALaminarFilmKeepsItsParabola) {
  // Ten rows, Re = 128: the noise viscosity is 4.5 times the water's own, and must not act on the shear.
  const double h = 0.4;
  const double nu = 0.005;
  const double pull = 0.1;
  CaseSpec spec;
  spec.particles.spacing = 0.1 * h;
  spec.physics.gravity = {pull, -g};
  spec.physics.viscosity = nu;
  spec.domain.periodic_x = {0.0, 1.2 * h};
  WallTable bed;
  bed.points = {{0.0, 0.0}, {1.2 * h, 0.0}};
  bed.slip = Slip::no_slip;
  spec.walls = {bed};
  FluidTable water;
  water.min = {0.0, 0.0};
  water.max = {1.2 * h, h};
  water.velocity = {"1.6*(1-(1-y/0.4)^2)", 0.0};
  spec.fluid = {water};
  Flow<2> flow = make_flow<2>(spec);
  const auto mean_speed = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (flow.state.particles.is_fluid(i)) sum += flow.state.particles.velocity[i][0];
    }
    return sum / static_cast<double>(count_fluid(flow));
  };
  while (flow.state.time < 8.0) step(flow);
  EXPECT_NEAR(mean_speed(), pull * h * h / (3.0 * nu), 0.02 * pull * h * h / (3.0 * nu));
}

TEST(BoundaryLayer, GrowsAsTheBalanceOfMomentumAsks) {
  // d delta/dt = kappa u_tau while the layer is thinner than dx. The production of the model gives c_b1/kappa u_tau,
  // 0.81 of this, and a little more diffuses upwards.
  Flow<2> flow = make_flow<2>(gliding_water<2>(Slip::no_slip));
  const auto thickness = [&] {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i) || flow.state.particles.position[i][1] > dx) continue;
      const WallLaw law{1e-6, 0.0};
      const double layer = flow.state.particles.layer_viscosity[i];
      const double u_tau = law.turbulent_friction_velocity(
          flow.state.particles.velocity[i][0], [&](double guess) { return spalart_allmaras::thickness(layer, guess); });
      sum += spalart_allmaras::thickness(layer, u_tau);
      ++count;
    }
    return sum / count;
  };
  for (int n = 0; n < 5; ++n) step(flow);
  const double before = thickness();
  const double time = flow.state.time;
  while (thickness() < 0.4 * dx && flow.state.time < 1.0) step(flow);
  const double growth = (thickness() - before) / (flow.state.time - time);
  // u_tau is 0.072 m/s in a layer 0.4 mm thick and 0.055 m/s in one of 4 mm.
  EXPECT_GT(growth, 0.6 * von_karman * 0.055);
  EXPECT_LT(growth, 1.2 * von_karman * 0.072);
}

}  // namespace boundary_layer_test
}  // namespace tailwater
