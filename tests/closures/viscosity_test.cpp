#include "closures/viscosity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "operators/gradient_corrected.h"
#include "operators/laplacian_morris.h"
#include "support/dimensions.h"
#include "support/pair_vectors.h"
#include "support/rounding.h"

namespace tailwater {
namespace viscosity_test {

constexpr double dx = 0.1;

template <class D>
class ViscosityTest : public testing::Test {};
TYPED_TEST_SUITE(ViscosityTest, Dimensions);

TEST(ViscosityLaw, GrowsWithTheSpeed) {
  const ViscosityLaw law{.molecular = 1e-6, .artificial = 0.02};
  EXPECT_DOUBLE_EQ(law.at_speed(0.0), 1e-6);
  EXPECT_DOUBLE_EQ(law.at_speed(2.0), 1e-6 + 0.04);
}

TYPED_TEST(ViscosityTest, ConservesMomentumAndDissipatesWhatItMust) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = fluid_at<Dim>(jittered_cube<Dim>(Dim == 2 ? 14 : 8, dx, 0.3), dx);
  Noise noise(41);
  for (double& volume : particles.volume) volume *= 1.0 + 0.3 * noise();
  const ParticleSet<Dim> set(std::move(particles), make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx), dx);
  const auto velocity = sample(set, [&](const Vec<Dim>&) { return noise.vector<Dim>(); });
  std::vector<double> viscosity(set.size());
  effective_viscosity<Dim>({.molecular = 1e-6, .artificial = 0.02}, velocity, viscosity);
  std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
  const std::vector<Mat<Dim>> no_gradient(set.size(), Mat<Dim>::Zero());
  add_newtonian_viscosity<Dim>(set.pairs(), set.particles, dx, kernel_gradients<Dim>(set), viscosity, 0.0, velocity,
                               no_gradient, acceleration);

  // Without gradients, each pair has force on i = - force on j and power = - w_i c_ij nu_ij |u_i - u_j|^2.
  const Pairs<Dim>& pairs = set.pairs();
  Vec<Dim> force = Vec<Dim>::Zero();
  double power = 0.0;
  double pair_power = 0.0;
  double forces = 0.0;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    const double w_i = set.particles.volume[i];
    force += w_i * acceleration[i];
    power += w_i * acceleration[i].dot(velocity[i]);
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      const double weight =
          w_i * morris_laplacian_weight(set.particles.volume[j], pairs.F(i, k), pairs.d(i, k).squaredNorm(), dx) * 0.5 *
          (viscosity[i] + viscosity[j]);
      pair_power -= 0.5 * weight * (velocity[i] - velocity[j]).squaredNorm();
      forces += weight * (velocity[i] - velocity[j]).norm();
    }
  }
  const double round_off = static_cast<double>(set.size() + 200) * eps * forces;
  EXPECT_LT(force.norm(), round_off);
  EXPECT_NEAR(power, pair_power, 4.0 * single_eps * forces);  // |u| < 2
  EXPECT_LT(power, 0.0);
}

TYPED_TEST(ViscosityTest, ARigidRotationIsFreeOfStressUpToTheSurface) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Mat<Dim> spin = Mat<Dim>::Zero();
  spin(0, 1) = -2.0;
  spin(1, 0) = 2.0;
  const auto velocity = sample(set, [&](const Vec<Dim>& x) { return Vec<Dim>(spin * x); });
  const std::vector<double> viscosity(set.size(), 0.1);
  std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
  add_newtonian_viscosity<Dim>(set.pairs(), set.particles, dx, kernel_gradients<Dim>(set), viscosity, 0.0, velocity,
                               std::vector<Mat<Dim>>(set.size(), spin), acceleration);
  // Each pair contributes 2 w dW (G + G^T) e, which is 0; its two parts are of the size nu spin/dx.
  for (const Vec<Dim>& a : acceleration) EXPECT_LT(a.norm(), 10.0 * single_eps * 0.1 * 2.0 / dx);
}

/// Adds only the noise viscosity, without any other viscosity.
template <int Dim>
void add_noise_viscosity(const ParticleSet<Dim>& set, const std::vector<Vec<Dim>>& velocity,
                         const std::vector<Mat<Dim>>& gradient, std::vector<Vec<Dim>>& acceleration) {
  add_newtonian_viscosity<Dim>(set.pairs(), set.particles, dx, kernel_gradients<Dim>(set),
                               std::vector<double>(set.size(), 0.0), 0.1, velocity, gradient, acceleration);
}

TYPED_TEST(ViscosityTest, NoiseViscosityConservesMomentumAndNeverAddsEnergy) {
  constexpr int Dim = TypeParam::value;
  ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Noise noise(43);
  const auto velocity = sample(set, [&](const Vec<Dim>&) { return noise.vector<Dim>(); });
  // Any gradients, right or wrong: the properties of the limiter do not depend on them.
  std::vector<Mat<Dim>> gradient(set.size());
  for (Mat<Dim>& entry : gradient) {
    for (int a = 0; a < Dim; ++a) entry.put_column(a, 20.0 * noise.vector<Dim>());
  }
  for (const double layer_viscosity : {0.0, 1.0, 1.0}) {
    std::ranges::fill(set.particles.layer_viscosity, layer_viscosity);
    std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
    add_noise_viscosity<Dim>(set, velocity, gradient, acceleration);
    Vec<Dim> force = Vec<Dim>::Zero();
    double forces = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
      force += acceleration[i];
      forces += acceleration[i].norm();
      power += acceleration[i].dot(velocity[i]);
    }
    EXPECT_LT(force.norm(), 300.0 * eps * forces);  // some 100 terms per particle, each rounded a few times
    EXPECT_LT(power, 0.0);
  }
}

TYPED_TEST(ViscosityTest, NoiseViscosityLeavesTheProfileOfALayerAlone) {
  constexpr int Dim = TypeParam::value;
  ParticleSet<Dim> set = jittered_block<Dim>(dx);
  // All differences point along x: those of the profile, and those of its gradient. The gradient is half the true one,
  // as beside a wall whose particles move with the slip velocity.
  const auto velocity =
      sample(set, [](const Vec<Dim>& x) { return Vec<Dim>(std::log(10.0 + x[1] / dx) * Vec<Dim>::UnitX()); });
  std::vector<Mat<Dim>> gradient(set.size(), Mat<Dim>::Zero());
  for (std::size_t i = 0; i < set.size(); ++i) gradient[i](0, 1) = 0.5 / (10.0 * dx + set.position(i)[1]);
  std::vector<Vec<Dim>> outside(set.size(), Vec<Dim>::Zero());
  std::vector<Vec<Dim>> inside = outside;
  add_noise_viscosity<Dim>(set, velocity, gradient, outside);
  std::ranges::fill(set.particles.layer_viscosity, 1.0);
  add_noise_viscosity<Dim>(set, velocity, gradient, inside);
  double largest = 0.0;
  for (const Vec<Dim>& a : outside) largest = std::max(largest, a.norm());
  EXPECT_GT(largest, 1e-3);
  for (std::size_t i = 0; i < set.pairs().owned(); ++i) EXPECT_LT(inside[i].norm(), 100.0 * single_eps * largest);
}

TYPED_TEST(ViscosityTest, NewtonianWithNoiseIsTheSumOfBoth) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Noise noise(44);
  const auto velocity = sample(set, [&](const Vec<Dim>&) { return noise.vector<Dim>(); });
  const std::vector<double> viscosity(set.size(), 0.03);
  const std::vector<Mat<Dim>> gradient(set.size(), Mat<Dim>::Constant(2.0));
  const PairVectorField<Dim> vectors = kernel_gradients<Dim>(set);
  const std::vector<Vec<Dim>> zero(set.size(), Vec<Dim>::Zero());
  std::vector<Vec<Dim>> together = zero;
  add_newtonian_viscosity<Dim>(set.pairs(), set.particles, dx, vectors, viscosity, 0.1, velocity, gradient, together);
  std::vector<Vec<Dim>> newtonian = zero;
  add_newtonian_viscosity<Dim>(set.pairs(), set.particles, dx, vectors, viscosity, 0.0, velocity, gradient, newtonian);
  std::vector<Vec<Dim>> of_noise = zero;
  add_noise_viscosity<Dim>(set, velocity, gradient, of_noise);
  for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
    ASSERT_GT(of_noise[i].norm(), 0.0);
    // Some 100 terms, each up to a hundred times the sum.
    ASSERT_LT((together[i] - newtonian[i] - of_noise[i]).norm(),
              100.0 * single_eps * (newtonian[i].norm() + of_noise[i].norm()));
  }
}

// Factors of the noise viscosity: 1 and 0 are with it and without it, and pairs of particles with both have half of it,
// so that momentum is conserved.
TYPED_TEST(ViscosityTest, NoiseViscosityHasTheMeanFactorOfEachPair) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Noise noise(45);
  const auto velocity = sample(set, [&](const Vec<Dim>&) { return noise.vector<Dim>(); });
  const std::vector<Mat<Dim>> gradient(set.size(), Mat<Dim>::Zero());
  const PairVectorField<Dim> vectors = kernel_gradients<Dim>(set);
  const auto with = [&](const std::vector<float>& factors) {
    std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
    add_newtonian_viscosity<Dim>(set.pairs(), set.particles, dx, vectors, std::vector<double>(set.size(), 0.0), 0.1,
                                 velocity, gradient, acceleration, {}, factors);
    return acceleration;
  };
  const std::vector<Vec<Dim>> all = with({});
  const std::vector<Vec<Dim>> half = with(std::vector<float>(set.size(), 0.5F));
  const std::vector<Vec<Dim>> none = with(std::vector<float>(set.size(), 0.0F));
  std::vector<float> mixed(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) mixed[i] = set.position(i)[0] < 0.0 ? 0.0F : 1.0F;
  const std::vector<Vec<Dim>> some = with(mixed);
  Vec<Dim> momentum = Vec<Dim>::Zero();
  double size = 0.0;
  for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
    ASSERT_EQ(none[i].norm(), 0.0);
    ASSERT_LT((2.0 * half[i] - all[i]).norm(), 100.0 * single_eps * all[i].norm());
    momentum += set.particles.volume[i] * some[i];
    size += set.particles.volume[i] * some[i].norm();
  }
  EXPECT_LT(momentum.norm(), 1e-12 * size);
}

TYPED_TEST(ViscosityTest, NoiseViscosityLeavesALinearVelocityAlone) {
  constexpr int Dim = TypeParam::value;
  constexpr int edge = Dim == 2 ? 14 : 10;
  const ParticleSet<Dim> set(jittered_cube<Dim>(edge, dx, 0.3), make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx),
                             dx);
  const Mat<Dim> slope = 3.0 * Mat<Dim>::Identity() + Mat<Dim>::Ones();
  const auto velocity = sample(set, [&](const Vec<Dim>& x) { return Vec<Dim>(slope * x); });
  const std::vector<Float4> in_single = as_float4<Dim>(velocity);
  std::vector<Mat<Dim>> gradient(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const KernelSums<Dim> sums = kernel_sums<Dim>(set.pairs(), i, {0.0, 1.0, 1.0});
    gradient[i] = corrected_gradient<Dim>(set.pairs(), i, sums.first_moment, in_single);
  }
  std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
  add_noise_viscosity<Dim>(set, velocity, gradient, acceleration);
  // Where the support is full the gradient is exact. The gradient of a neighbour must be exact as well, hence a
  // distance of two supports from the edge.
  const double inside = (0.5 * edge - 0.5 - 3.3) * dx;
  const double unit = slope.norm() * 0.1 / (dx * dx) * dx;  // nu u/dx^2 with |u| = slope dx
  std::size_t tested = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (set.position(i).cwiseAbs().maxCoeff() > inside) continue;
    ++tested;
    EXPECT_LT(acceleration[i].norm(), 10.0 * single_eps * unit);
  }
  EXPECT_GT(tested, 0u);
}

TYPED_TEST(ViscosityTest, LeavesAUniformVelocityAlone) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  const auto velocity = sample(set, [](const Vec<Dim>&) { return Vec<Dim>(Vec<Dim>::Constant(1.7)); });
  const std::vector<double> viscosity(set.size(), 0.1);
  std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
  const std::vector<Mat<Dim>> no_gradient(set.size(), Mat<Dim>::Zero());
  add_newtonian_viscosity<Dim>(set.pairs(), set.particles, dx, kernel_gradients<Dim>(set), viscosity, 0.0, velocity,
                               no_gradient, acceleration);
  for (const Vec<Dim>& a : acceleration) EXPECT_EQ(a, Vec<Dim>(Vec<Dim>::Zero()));
}

}  // namespace viscosity_test
}  // namespace tailwater
