// Identities that hold pair by pair, for any set of particles.
#include <gtest/gtest.h>

#include <vector>

#include "operators/divergence.h"
#include "operators/gradient_conservative.h"
#include "operators/laplacian_morris.h"
#include "support/dimensions.h"
#include "support/pair_vectors.h"
#include "support/rounding.h"

namespace tailwater {
namespace conservation_test {

constexpr double dx = 0.1;

template <class D>
class ConservationTest : public testing::Test {};
TYPED_TEST_SUITE(ConservationTest, Dimensions);

/// A jittered block with edges, with different volumes and two coincident particles.
template <int Dim>
ParticleSet<Dim> disorder(KernelName name) {
  std::vector<Vec<Dim>> points = jittered_cube<Dim>(Dim == 2 ? 14 : 8, dx, 0.4);
  points.push_back(points[points.size() / 2]);
  Particles<Dim> particles = fluid_at<Dim>(points, dx);
  Noise noise(11);
  for (double& volume : particles.volume) volume *= 1.0 + 0.3 * noise();
  return ParticleSet<Dim>(std::move(particles), make_kernel<Dim>(name, 3.0 * dx), dx);
}

TYPED_TEST(ConservationTest, ForcesOfTheConservativeGradientSumToZero) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : {KernelName::wendland_c2, KernelName::cubic_spline, KernelName::farzin}) {
    const ParticleSet<Dim> set = disorder<Dim>(name);
    Noise noise(12);
    const auto pressure = sample(set, [&](const Vec<Dim>&) { return 1000.0 * noise(); });
    const Pairs<Dim>& pairs = set.pairs();
    const auto vectors = kernel_gradients<Dim>(set);
    Vec<Dim> sum = Vec<Dim>::Zero();
    double terms = 0.0;
    for (std::size_t i = 0; i < pairs.owned(); ++i) {
      const double w_i = set.particles.volume[i];
      sum += w_i * conservative_gradient<Dim>(pairs, i, set.particles.volume, vectors, pressure);
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
        const auto j = pairs.j[k];
        terms += std::abs(w_i * set.particles.volume[j] * pairs.slope(i, k) * (pressure[i] + pressure[j]));
      }
    }
    // Summation error: at most (terms in a row + rows) eps times the sum of all magnitudes.
    EXPECT_LT(sum.norm(), static_cast<double>(pairs.owned() + 200) * eps * terms);
    EXPECT_GT(terms, 0.0);
  }
}

TYPED_TEST(ConservationTest, StandardDivergenceOfAUniformVelocityIsZero) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = disorder<Dim>(KernelName::wendland_c2);
  const std::vector<Float4> velocity(set.size(), Float4{{3.7F, 3.7F, 3.7F}});
  const auto vectors = kernel_gradients<Dim>(set);
  for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
    EXPECT_EQ(standard_divergence<Dim>(set.pairs(), i, vectors, velocity), 0.0);
  }
}

TYPED_TEST(ConservationTest, StandardDivergenceIsTheAdjointOfTheConservativeGradient) {
  constexpr int Dim = TypeParam::value;
  // sum w_i p_i div u_i = sum_ij w_i w_j p_i (u_j - u_i) . grad W = - sum w_i u_i . grad p_i, pair by pair: the
  // pressure of a divergence-free velocity does no work.
  const ParticleSet<Dim> set = disorder<Dim>(KernelName::wendland_c2);
  Noise noise(13);
  const auto pressure = sample(set, [&](const Vec<Dim>&) { return noise(); });
  const auto velocity = sample(set, [&](const Vec<Dim>&) { return noise.vector<Dim>(); });
  const std::vector<double>& volume = set.particles.volume;
  const Pairs<Dim>& pairs = set.pairs();
  const auto vectors = kernel_gradients<Dim>(set);
  const std::vector<Float4> in_single = as_float4<Dim>(velocity);
  double sum = 0.0;
  double terms = 0.0;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    sum += volume[i] * pressure[i] * standard_divergence<Dim>(pairs, i, vectors, in_single);
    sum += volume[i] * velocity[i].dot(conservative_gradient<Dim>(pairs, i, set.particles.volume, vectors, pressure));
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      terms += 4.0 * std::sqrt(Dim) * volume[i] * volume[pairs.j[k]] * std::abs(pairs.slope(i, k));
    }
  }
  // Velocities and products of a pair are rounded to single precision.
  EXPECT_LT(std::abs(sum), 4.0 * single_eps * terms);
}

TYPED_TEST(ConservationTest, MorrisWeightsAreSymmetricAndNeverNegative) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : {KernelName::wendland_c2, KernelName::cubic_spline, KernelName::farzin}) {
    const auto kernel = make_kernel<Dim>(name, 3.0 * dx);
    for (int n = 1; n <= 400; ++n) {
      const double r = 0.01 * n * dx;
      const double weight = morris_laplacian_weight(power<Dim>(dx), kernel_steepness(kernel, r), r * r, dx);
      EXPECT_GE(weight, 0.0);
      // Bounded for pairing particles: |dW|/r with r at least a tenth of dx.
      EXPECT_LE(weight, 2.0 * power<Dim>(dx) * kernel_steepness(kernel, r) * r / (0.1 * dx) * (1.0 + 4.0 * eps));
    }
  }
}

}  // namespace conservation_test
}  // namespace tailwater
