// Properties that the discrete viscous forces have exactly (rheology/viscous_operator.h).
#include <gtest/gtest.h>

#include <random>

#include "rheology/liquids.h"
#include "rheology/viscous_operator.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class D>
class ViscousForces : public testing::Test {};
TYPED_TEST_SUITE(ViscousForces, Dimensions);

/// Particles of a jittered block, with a tank around it if it has walls, and the operator with another viscosity for
/// each particle, from 1 to 1000.
template <int Dim>
struct Block {
  explicit Block(bool has_walls, double friction = 1.0) : flow(make_flow<Dim>(make_case(has_walls, friction))) {
    locate(flow);
    forces.locate(flow, {flow.state.wall_velocity, {}});
    const Particles<Dim>& particles = flow.state.particles;
    std::vector<double> viscosity(particles.owned, 0.0);
    for (std::size_t i = 0; i < viscosity.size(); ++i) {
      if (particles.is_fluid(i)) viscosity[i] = std::pow(1000.0, random(engine));
    }
    forces.set_viscosity(flow, viscosity);
  }

  static CaseSpec make_case(bool has_walls, double friction) {
    CaseSpec spec = tank_case<Dim>(0.1, 0.8, 0.6);
    spec.particles.jitter = 0.2;
    for (WallTable& wall : spec.walls) {
      wall.slip = Slip::partial;
      wall.friction = friction;
    }
    if (!has_walls) spec.walls.clear();
    fill_with(spec, newtonian(1000.0));
    return spec;
  }

  std::vector<Vec<Dim>> random_velocity() {
    std::vector<Vec<Dim>> velocity(flow.state.particles.size(), Vec<Dim>::Zero());
    for (std::size_t i = 0; i < flow.state.particles.owned; ++i) {
      if (!flow.state.particles.is_fluid(i)) continue;
      for (int a = 0; a < Dim; ++a) velocity[i][a] = 2.0 * random(engine) - 1.0;
    }
    return velocity;
  }
  std::vector<Vec<Dim>> forces_at(std::vector<Vec<Dim>> velocity) {
    std::vector<Vec<Dim>> force(flow.state.particles.owned);
    forces.find_forces(flow, velocity, force);
    return force;
  }
  double power(const std::vector<Vec<Dim>>& force, const std::vector<Vec<Dim>>& velocity) const {
    return sum_over(force.size(), 0.0, [&](std::size_t i) { return force[i].dot(velocity[i]); });
  }

  std::mt19937 engine{7};
  std::uniform_real_distribution<double> random{0.0, 1.0};
  Flow<Dim> flow;
  ViscousOperator<Dim> forces;
};

constexpr double rounding = 1e-5;  // of sums over a hundred pairs in single precision

TYPED_TEST(ViscousForces, AreSymmetricAndDissipate) {
  constexpr int Dim = TypeParam::value;
  for (const double friction : {-1.0, 0.0, 0.3, 1.0}) {  // without walls, of free slip, ...
    Block<Dim> block(friction >= 0.0, friction);
    const std::vector<Vec<Dim>> u = block.random_velocity();
    const std::vector<Vec<Dim>> v = block.random_velocity();
    const double uu = block.power(block.forces_at(u), u);
    EXPECT_LT(uu, 0.0);
    EXPECT_NEAR(block.power(block.forces_at(u), v), block.power(block.forces_at(v), u), -rounding * uu);
  }
}

TYPED_TEST(ViscousForces, DissipateViscosityTimesShearRateSquared) {
  constexpr int Dim = TypeParam::value;
  for (const double friction : {0.0, 0.3, 1.0}) {
    Block<Dim> block(true, friction);
    const std::vector<Vec<Dim>> u = block.random_velocity();
    const Particles<Dim>& particles = block.flow.state.particles;
    std::vector<double> rate(particles.owned);
    block.forces.find_shear_rates(block.flow, u, rate);
    const double dissipated = sum_over(particles.owned, 0.0, [&](std::size_t i) {
      return particles.volume[i] * block.forces.viscosity()[i] * rate[i] * rate[i];
    });
    EXPECT_NEAR(-block.power(block.forces_at(u), u) / dissipated, 1.0, rounding) << friction;
  }
}

TYPED_TEST(ViscousForces, ConserveLinearAndAngularMomentum) {
  constexpr int Dim = TypeParam::value;
  Block<Dim> block(false);
  const std::vector<Vec<Dim>> force = block.forces_at(block.random_velocity());
  const Particles<Dim>& particles = block.flow.state.particles;
  Vec<Dim> sum = Vec<Dim>::Zero();
  double torque = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    sum += force[i];
    torque += particles.position[i][0] * force[i][1] - particles.position[i][1] * force[i][0];
    size += force[i].norm();
  }
  EXPECT_LT(sum.norm(), rounding * size);
  EXPECT_LT(std::abs(torque), rounding * size);
}

TYPED_TEST(ViscousForces, VanishInRigidMotion) {
  constexpr int Dim = TypeParam::value;
  Block<Dim> block(false);
  const Particles<Dim>& particles = block.flow.state.particles;
  std::vector<Vec<Dim>> rigid(particles.size());
  for (std::size_t i = 0; i < rigid.size(); ++i) {
    rigid[i] = Vec<Dim>::Constant(0.3);
    rigid[i][0] -= 2.0 * particles.position[i][1];
    rigid[i][1] += 2.0 * particles.position[i][0];
  }
  std::vector<double> rate(particles.owned);
  block.forces.find_shear_rates(block.flow, rigid, rate);
  for (std::size_t i = 0; i < rate.size(); ++i) EXPECT_LT(rate[i], 4.0 * rounding) << i;  // of a vorticity of 4
  const double power = block.power(block.forces_at(rigid), rigid);
  const std::vector<Vec<Dim>> u = block.random_velocity();
  EXPECT_LT(std::abs(power), rounding * -block.power(block.forces_at(u), u));
}

// Away from the bed, shear of 1/s is seen to the last digits, at the free surface too.
TEST(ShearRates, AreExactInUniformShear) {
  CaseSpec spec = channel_case(newtonian(1000.0), 0.1, 0.0, 0.0);
  spec.particles.jitter = 0.0;
  spec.walls.pop_back();
  Flow<2> flow = make_flow<2>(spec);
  locate(flow);
  ViscousOperator<2> forces;
  forces.locate(flow, {flow.state.wall_velocity, {}});
  const Particles<2>& particles = flow.state.particles;
  std::vector<Vec<2>> shear(particles.size());
  for (std::size_t i = 0; i < shear.size(); ++i) shear[i] = {particles.position[i][1], 0.0};
  std::vector<double> rate(particles.owned);
  forces.find_shear_rates(flow, shear, rate);
  for (std::size_t i = 0; i < rate.size(); ++i) {
    if (!particles.is_fluid(i) || particles.position[i][1] < 0.3) continue;
    EXPECT_NEAR(rate[i], 1.0, rounding) << i;
  }
}

}  // namespace
}  // namespace tailwater
