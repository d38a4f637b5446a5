#include "published/smagorinsky.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/dimensions.h"
#include "support/particle_set.h"
#include "support/rounding.h"

namespace tailwater {
namespace smagorinsky_test {

constexpr double dx = 0.1;
constexpr double c_s = 0.1;

/// Relative round-off of the gradient of a linear field: some hundred terms, condition of A at most 1/0.1, coordinates
/// ten times the distances.
constexpr double gradient_error = 1e5 * eps;

template <class D>
class SmagorinskyTest : public testing::Test {};
TYPED_TEST_SUITE(SmagorinskyTest, Dimensions);

template <int Dim>
std::vector<Mat<Dim>> stress_of(const ParticleSet<Dim>& set, const Mat<Dim>& gradient) {
  const auto velocity =
      sample(set, [&](const Vec<Dim>& x) { return Vec<Dim>(Vec<Dim>::Constant(0.5) + gradient * x); });
  std::vector<Mat<Dim>> stress(set.size(), Mat<Dim>::Ones());
  sub_particle_stress<Dim>(set.pairs(), set.particles, c_s, dx, velocity, stress);
  return stress;
}

TYPED_TEST(SmagorinskyTest, UniformFlowAndRigidRotationHaveNone) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Mat<Dim> rotation = Mat<Dim>::Zero();
  rotation(0, 1) = -2.0;
  rotation(1, 0) = 2.0;
  for (const Mat<Dim>& gradient : {Mat<Dim>(Mat<Dim>::Zero()), rotation}) {
    // The stress is quadratic in S, which is only round-off here.
    const double S = 2.0 * gradient_error;
    for (const Mat<Dim>& stress : stress_of<Dim>(set, gradient)) EXPECT_LT(stress.norm(), dx * dx * S * S);
  }
}

TYPED_TEST(SmagorinskyTest, SimpleShear) {
  constexpr int Dim = TypeParam::value;
  // u = G y: S_xy = G/2, |S| = sqrt(2 S:S) = G, nu_t = (c_s dx)^2 G, k = (nu_t/(0.08 dx))^2; exact at edges as well.
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  const double G = 3.0;
  const double nu_t = c_s * c_s * dx * dx * G;
  const double k = std::pow(nu_t / (0.08 * dx), 2);
  Mat<Dim> expected = -2.0 / 3.0 * k * Mat<Dim>::Identity();
  expected(0, 1) = expected(1, 0) = nu_t * G;
  const auto stress = stress_of<Dim>(set, G * Vec<Dim>::UnitX() * Vec<Dim>::UnitY().transpose());
  std::size_t tested = 0;
  for (const Mat<Dim>& tau : stress) {
    if (tau.isZero(0.0)) continue;  // too few neighbours for a gradient: a corner
    ++tested;
    EXPECT_LT((tau - expected).norm(), 4.0 * gradient_error * expected.norm());
  }
  EXPECT_GT(tested, set.size() / 2);
}

TYPED_TEST(SmagorinskyTest, LoneParticlesHaveNone) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Vec<Dim>> two{Vec<Dim>::Zero(), dx * Vec<Dim>::UnitX()};
  const ParticleSet<Dim> set(two, make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx), dx);
  for (const Mat<Dim>& tau : stress_of<Dim>(set, Mat<Dim>::Ones())) EXPECT_TRUE(tau.isZero(0.0));
}

TYPED_TEST(SmagorinskyTest, DivergenceConservesMomentum) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Noise noise(51);
  std::vector<Mat<Dim>> stress(set.size());
  for (Mat<Dim>& tau : stress) {
    for (int d = 0; d < Dim; ++d) tau.put_column(d, noise.vector<Dim>());
  }
  std::vector<Vec<Dim>> acceleration(set.size(), Vec<Dim>::Zero());
  add_stress_divergence<Dim>(set.pairs(), set.particles, stress, acceleration);
  const Pairs<Dim>& pairs = set.pairs();
  Vec<Dim> force = Vec<Dim>::Zero();
  double forces = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    force += set.particles.volume[i] * acceleration[i];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      forces += 2.0 * Dim * set.particles.volume[i] * set.particles.volume[pairs.j[k]] * std::abs(pairs.slope(i, k));
    }
  }
  EXPECT_LT(force.norm(), static_cast<double>(set.size() + 200) * eps * forces);
  EXPECT_GT(acceleration[set.size() / 2].norm(), 0.0);
}

}  // namespace smagorinsky_test
}  // namespace tailwater
