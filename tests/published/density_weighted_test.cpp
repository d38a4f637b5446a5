// The operators of the two-step scheme, (B6)-(B8): identities pair by pair for any set, and values on a lattice.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "operators/concentration.h"
#include "operators/gradient_conservative.h"
#include "operators/laplacian_morris.h"
#include "operators/lattice.h"
#include "published/gradient_density_weighted.h"
#include "published/laplacian_shao_lo.h"
#include "support/dimensions.h"
#include "support/pair_vectors.h"
#include "support/particle_set.h"
#include "support/rounding.h"

namespace tailwater {
namespace density_weighted_test {

constexpr double dx = 0.1;
constexpr double radius = 2.4 * dx;  // h = 1.2 dx

template <class D>
class DensityWeightedTest : public testing::Test {};
TYPED_TEST_SUITE(DensityWeightedTest, Dimensions);

template <int Dim>
ParticleSet<Dim> cube(double jitter) {
  return ParticleSet<Dim>(jittered_cube<Dim>(Dim == 2 ? 14 : 9, dx, jitter),
                          make_kernel<Dim>(KernelName::cubic_spline, radius), dx);
}

/// Whether the whole support is inside the cube.
template <int Dim>
bool is_interior(const ParticleSet<Dim>& set, std::size_t i) {
  return set.position(i).cwiseAbs().maxCoeff() < (0.5 * (Dim == 2 ? 14 : 9) - 0.5) * dx - radius;
}

/// Terms in a row, and rows: the factor of eps in a sum over all pairs.
template <int Dim>
double count_of_terms(const ParticleSet<Dim>& set) {
  return static_cast<double>(set.size() + 200);
}

TYPED_TEST(DensityWeightedTest, ForcesSumToZeroAndHaveNoTorque) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = cube<Dim>(0.4);
  Noise noise(21);
  const auto pressure = sample(set, [&](const Vec<Dim>&) { return 1000.0 * noise(); });
  const auto density = sample(set, [&](const Vec<Dim>&) { return 1.0 + 0.3 * noise(); });
  const Pairs<Dim>& pairs = set.pairs();
  const std::vector<double>& volume = set.particles.volume;
  Vec<Dim> force = Vec<Dim>::Zero();
  double torque = 0.0;  // about z
  double terms = 0.0;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    const Vec<Dim> f = volume[i] * density_weighted_gradient<Dim>(pairs, i, volume, density, pressure);
    force += f;
    torque += set.position(i)[0] * f[1] - set.position(i)[1] * f[0];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      terms += volume[i] * volume[j] * std::abs(pairs.slope(i, k)) *
               (std::abs(pressure[i]) / std::pow(density[i], 2) + std::abs(pressure[j]) / std::pow(density[j], 2));
    }
  }
  ASSERT_GT(terms, 0.0);
  const double round_off = count_of_terms(set) * eps * terms;
  EXPECT_LT(force.norm(), round_off);
  EXPECT_LT(std::abs(torque), 2.0 * round_off);  // arms are shorter than 1 m
}

TYPED_TEST(DensityWeightedTest, IsTheConservativeGradientAtFullDensity) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = cube<Dim>(0.3);
  Noise noise(22);
  const auto pressure = sample(set, [&](const Vec<Dim>&) { return noise(); });
  const std::vector<double> density(set.size(), 1.0);
  const auto vectors = kernel_gradients<Dim>(set);
  for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
    double terms = 0.0;
    for (std::size_t k = set.pairs().begin(i); k < set.pairs().end(i); ++k) {
      terms += 2.0 * set.particles.volume[set.pairs().j[k]] * std::abs(set.pairs().slope(i, k));  // |p| < 1
    }
    EXPECT_LT((density_weighted_gradient<Dim>(set.pairs(), i, set.particles.volume, density, pressure) -
               conservative_gradient<Dim>(set.pairs(), i, set.particles.volume, vectors, pressure))
                  .norm(),
              4.0 * single_eps * terms);
  }
}

TYPED_TEST(DensityWeightedTest, ShaoLoWeightsAreSymmetricAndMorrisWithoutEta) {
  const auto kernel = make_kernel<TypeParam::value>(KernelName::cubic_spline, radius);
  for (int n = 1; n <= 240; ++n) {
    const double r = 0.01 * n * dx;
    const double dW = -kernel_steepness(kernel, r) * r;
    const double weight = shao_lo_laplacian_weight(0.01, 0.7, 1.1, r, dW, shao_lo_eta_squared(radius));
    EXPECT_GE(weight, 0.0);
    EXPECT_EQ(weight, shao_lo_laplacian_weight(0.01, 1.1, 0.7, r, dW, shao_lo_eta_squared(radius)));
    if (r >= min_morris_distance * dx) {
      const double morris = morris_laplacian_weight(0.01, -dW / r, r * r, dx);
      EXPECT_NEAR(shao_lo_laplacian_weight(0.01, 1.0, 1.0, r, dW, 0.0), morris, 8.0 * eps * morris);
    }
  }
}

TYPED_TEST(DensityWeightedTest, LatticeHasFullDensityAndGivesLinearFieldsNoLaplacian) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = cube<Dim>(0.0);
  const Kernel<Dim>& kernel = set.neighbourhood.kernel();
  const LatticeSums lattice = lattice_sums(kernel, dx);
  const Pairs<Dim>& pairs = set.pairs();
  int tested = 0;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    if (!is_interior(set, i)) continue;
    ++tested;
    EXPECT_NEAR(kernel_sums<Dim>(pairs, i, kernel_values_of(kernel, dx)).concentration / lattice.concentration, 1.0,
                10.0 * single_eps);
    double sum = 0.0;
    double linear = 0.0;
    double square = 0.0;
    double second_moment = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const double c_ij = shao_lo_laplacian_weight(set.particles.volume[pairs.j[k]], 1.0, 1.0, pairs.r(i, k),
                                                   pairs.slope(i, k), shao_lo_eta_squared(radius));
      const double x = -pairs.r(i, k) * pairs.e(i, k)[0];
      sum += c_ij;
      linear += c_ij * x;
      square += c_ij * x * x;
      second_moment += c_ij * pairs.r(i, k) * pairs.r(i, k);
    }
    EXPECT_NEAR(linear, 0.0, 10.0 * single_eps * sum * radius);
    // A lattice has no preferred direction: lap(x^2) is lap(r^2)/Dim.
    EXPECT_NEAR(square, second_moment / Dim, 10.0 * single_eps * second_moment);
  }
  EXPECT_GT(tested, 0);
}

}  // namespace density_weighted_test
}  // namespace tailwater
