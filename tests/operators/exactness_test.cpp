// Fields that the operators reproduce exactly. Bounds are round-off: eps times the size of the summands times a
// condition number, never an observed error.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "operators/concentration.h"
#include "operators/divergence.h"
#include "operators/gradient_conservative.h"
#include "operators/laplacian_morris.h"
#include "operators/lattice.h"
#include "support/dimensions.h"
#include "support/pair_vectors.h"
#include "support/rounding.h"
#include "support/tensors.h"

namespace tailwater {
namespace exactness_test {

constexpr double dx = 0.05;
constexpr double radius = 3.0 * dx;
constexpr std::array all_kernels{KernelName::wendland_c2, KernelName::cubic_spline, KernelName::farzin};
constexpr std::array jitters{0.0, 0.1, 0.3};

template <class D>
class ExactnessTest : public testing::Test {};
TYPED_TEST_SUITE(ExactnessTest, Dimensions);

template <int Dim>
constexpr int cube_count = Dim == 2 ? 16 : 9;

template <int Dim>
ParticleSet<Dim> cube(KernelName kernel, double jitter) {
  return ParticleSet<Dim>(jittered_cube<Dim>(cube_count<Dim>, dx, jitter), make_kernel<Dim>(kernel, radius), dx);
}

/// Whether the whole support is inside the cube.
template <int Dim>
bool is_interior(const Vec<Dim>& position) {
  return position.cwiseAbs().maxCoeff() < (0.5 * cube_count<Dim> - 0.5 - 0.3) * dx - radius;
}

template <int Dim>
Vec<Dim> some_vector() {
  Vec<Dim> g = Vec<Dim>::Constant(0.7);
  g[0] = -1.3;
  return g;
}

template <int Dim>
Mat<Dim> some_symmetric_matrix() {
  Mat<Dim> H = Mat<Dim>::Constant(0.6);
  for (int d = 0; d < Dim; ++d) H(d, d) = 1.5 - d;
  return H;
}

TYPED_TEST(ExactnessTest, GradientOfLinearFieldsInteriorAndEdges) {
  constexpr int Dim = TypeParam::value;
  const Vec<Dim> g = some_vector<Dim>();
  Mat<Dim> G = some_symmetric_matrix<Dim>();
  G(0, 1) += 0.9;
  for (const KernelName kernel : all_kernels) {
    for (const double jitter : jitters) {
      const ParticleSet<Dim> set = cube<Dim>(kernel, jitter);
      const ConsistentOperators<Dim> operators(set);
      const auto linear = sample(set, [&](const Vec<Dim>& x) { return 2.0 + g.dot(x); });
      const auto linear_vector = sample(set, [&](const Vec<Dim>& x) { return Vec<Dim>(Vec<Dim>::Ones() + G * x); });
      const auto uniform = sample(set, [](const Vec<Dim>&) { return 5.0; });
      for (std::size_t i = 0; i < set.size(); ++i) {
        const Renormalisation<Dim>& tensors = operators.tensors[i];
        if (jitter == 0.0) {
          // On a regular block one octant of neighbours remains at a corner, which spans space.
          ASSERT_TRUE(tensors.has_inverse);
        }
        if (!tensors.gradient_is_sound()) continue;
        // Differences of values of size 2 have errors of 4 eps; their weights sum to at most tr A |B1| sqrt(Dim)/r_min.
        double weights = 0.0;
        for (std::size_t k = set.pairs().begin(i); k < set.pairs().end(i); ++k) {
          weights += consistent_gradient_weight<Dim>(tensors.B1, set.particles.volume[i], set.pairs().e(i, k),
                                                     set.pairs().r(i, k), set.pairs().value(i, k))
                         .norm();
        }
        const double condition = tensors.trace_A / tensors.min_eigenvalue_A;
        const double bound = 16.0 * eps * weights + 64.0 * eps * condition * g.norm();
        ASSERT_LT((operators.gradient(i, linear) - g).norm(), bound);
        ASSERT_LT((operators.gradient(i, linear_vector) - G).norm(), 2.0 * bound);
        ASSERT_EQ(operators.gradient(i, uniform), Vec<Dim>(Vec<Dim>::Zero()));
      }
    }
  }
}

TYPED_TEST(ExactnessTest, TensorsAreSoundInsideAndOnFlatEdgesOfALattice) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName kernel : all_kernels) {
    for (const double jitter : jitters) {
      const ParticleSet<Dim> set = cube<Dim>(kernel, jitter);
      const ConsistentOperators<Dim> operators(set);
      for (std::size_t i = 0; i < set.size(); ++i) {
        if (is_interior<Dim>(set.position(i))) {
          EXPECT_TRUE(operators.tensors[i].laplacian_is_sound());
        }
      }
    }
    const ParticleSet<Dim> set = cube<Dim>(kernel, 0.0);
    const ConsistentOperators<Dim> operators(set);
    const double edge = 0.5 * (cube_count<Dim> - 1) * dx;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const Vec<Dim> out = set.position(i).cwiseAbs();
      const auto on_edge = std::ranges::count_if(out, [&](double x) { return x > edge - 0.5 * dx; });
      const auto inside = std::ranges::count_if(out, [&](double x) { return x < edge - radius; });
      if (on_edge == 1 && inside == Dim - 1) {
        EXPECT_TRUE(operators.tensors[i].gradient_is_sound());
      }
    }
  }
}

TYPED_TEST(ExactnessTest, LaplacianOfQuadraticFieldsInteriorAndEdges) {
  constexpr int Dim = TypeParam::value;
  const Mat<Dim> H = some_symmetric_matrix<Dim>();
  const auto function = [&](const Vec<Dim>& x) { return 1.0 + some_vector<Dim>().dot(x) + 0.5 * x.dot(H * x); };
  for (const KernelName kernel : all_kernels) {
    for (const double jitter : jitters) {
      const ParticleSet<Dim> set = cube<Dim>(kernel, jitter);
      const ConsistentOperators<Dim> operators(set);
      const auto quadratic = sample(set, function);
      const auto vector = sample(set, [&](const Vec<Dim>& x) { return Vec<Dim>(function(x) * some_vector<Dim>()); });
      std::size_t tested = 0;
      std::size_t at_edges = 0;
      for (std::size_t i = 0; i < set.size(); ++i) {
        if (!operators.tensors[i].laplacian_is_sound()) continue;
        ++tested;
        at_edges += !is_interior<Dim>(set.position(i));
        double weights = 0.0;
        for (std::size_t k = set.pairs().begin(i); k < set.pairs().end(i); ++k) {
          weights += std::abs(operators.laplacian_weight(i, k));
        }
        // Values of size up to 3 are rounded, and so are the weights. B2 comes from a system of at most 6 unknowns,
        // with a condition number below about 1e3 where the tensors are sound.
        const double bound = 1e3 * 16.0 * eps * weights * radius + 16.0 * eps * 3.0 * weights;
        ASSERT_LT(std::abs(operators.laplacian(i, quadratic) - H.trace()), bound);
        ASSERT_LT((operators.laplacian(i, vector) - H.trace() * some_vector<Dim>()).norm(), 2.0 * bound);
      }
      EXPECT_GT(tested, 0u);
      EXPECT_GT(at_edges, 0u);
    }
  }
}

TYPED_TEST(ExactnessTest, SignOfTheSecondTermOfF23) {
  constexpr int Dim = TypeParam::value;
  // With v = g . x the first term of (F23) sums to -2 (C : B2) . g and the second to 2 drift . A . g. These cancel
  // because drift = A^-1 (C : B2). The "+" of the scanned paper leaves -4 (A drift) . g, which is of order |g|/dx where
  // the set has no symmetry.
  const Vec<Dim> g = some_vector<Dim>();
  const ParticleSet<Dim> set = cube<Dim>(KernelName::farzin, 0.3);
  const ConsistentOperators<Dim> operators(set);
  const auto linear = sample(set, [&](const Vec<Dim>& x) { return g.dot(x); });
  double largest = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!operators.tensors[i].laplacian_is_sound()) continue;
    Renormalisation<Dim> printed = operators.tensors[i];
    printed.drift = -printed.drift;
    const Pairs<Dim>& pairs = set.pairs();
    Mat<Dim> A = Mat<Dim>::Zero();
    double with_plus = 0.0;
    double weights = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      A += set.particles.volume[j] * pairs.value(i, k) * pairs.e(i, k) * pairs.e(i, k).transpose();
      const double weight = consistent_laplacian_weight<Dim>(printed, set.particles.volume[j], pairs.e(i, k),
                                                             pairs.r(i, k), pairs.value(i, k));
      with_plus += weight * (linear[j] - linear[i]);
      weights += std::abs(weight) + std::abs(operators.laplacian_weight(i, k));
    }
    const double round_off = 1e3 * 16.0 * eps * weights * radius;
    EXPECT_NEAR(operators.laplacian(i, linear), 0.0, round_off);
    EXPECT_NEAR(with_plus, 4.0 * printed.drift.dot(A * g), round_off);
    largest = std::max(largest, std::abs(with_plus));
  }
  EXPECT_GT(largest, g.norm() / dx);
}

TYPED_TEST(ExactnessTest, NeighboursThatDoNotSpanSpaceGiveNoTensors) {
  constexpr int Dim = TypeParam::value;
  const auto kernel = make_kernel<Dim>(KernelName::wendland_c2, radius);
  for (const int count : {1, 2, 3, 5}) {
    std::vector<Vec<Dim>> line;
    for (int n = 0; n < count; ++n) line.push_back(n * dx * Vec<Dim>::UnitX());
    const ParticleSet<Dim> set(line, kernel, dx);
    for (const Renormalisation<Dim>& tensors : ConsistentOperators<Dim>(set).tensors) {
      EXPECT_FALSE(tensors.has_inverse);
      EXPECT_FALSE(tensors.gradient_is_sound());
      EXPECT_FALSE(tensors.laplacian_is_sound());
    }
  }
}

TYPED_TEST(ExactnessTest, KernelSumsAreThoseOfThePairs) {
  constexpr int Dim = TypeParam::value;
  const Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, 3.0 * dx);
  const ParticleSet<Dim> set(jittered_cube<Dim>(7, dx, 0.3), kernel, dx);
  const Pairs<Dim>& pairs = set.pairs();
  const KernelValues values = kernel_values_of(kernel, dx);
  for (std::size_t i = 0; i < set.size(); ++i) {
    KernelSums<Dim> expected{set.particles.volume[i] * values.W_0, Vec<Dim>::Zero(), Mat<Dim>::Zero(),
                             Vec<Dim>::Zero()};
    double steepnesses = 0.0;  // 1/m; magnitude of the terms that may cancel
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const double volume = set.particles.volume[pairs.j[k]];
      const double closeness = std::pow(pairs.value(i, k), 4) - std::pow(kernel_value(kernel, 0.8 * dx), 4);
      const double pairing = 1.0 + 0.2 * std::max(0.0, closeness / std::pow(values.W_spacing, 4));
      expected.concentration += volume * pairs.value(i, k);
      expected.gradient += volume * pairs.gradient(i, k);
      expected.first_moment -= volume * pairs.d(i, k) * pairs.gradient(i, k).transpose();
      expected.crowding += volume * pairing * pairs.gradient(i, k);
      steepnesses += volume * pairing * pairs.gradient(i, k).norm();
    }
    const KernelSums<Dim> found = kernel_sums<Dim>(pairs, i, values);
    const double in_single = 16.0 * single_eps;
    ASSERT_NEAR(found.concentration, expected.concentration, in_single);
    ASSERT_LT((found.gradient - expected.gradient).norm(), in_single * steepnesses);
    ASSERT_LT((found.first_moment - expected.first_moment).norm(), in_single);
    ASSERT_LT((found.crowding - expected.crowding).norm(), in_single * steepnesses);
  }
}

TYPED_TEST(ExactnessTest, LatticeSumsAreWhatALatticeParticleSees) {
  constexpr int Dim = TypeParam::value;
  for (const KernelName name : all_kernels) {
    const auto kernel = make_kernel<Dim>(name, radius);
    const LatticeSums sums = lattice_sums<Dim>(kernel, dx);
    const ParticleSet<Dim> set = cube<Dim>(name, 0.0);
    const Pairs<Dim>& pairs = set.pairs();
    const auto vectors = kernel_gradients<Dim>(set);
    const auto linear = sample(set, [](const Vec<Dim>& x) { return some_vector<Dim>().dot(x); });
    const Mat<Dim> G = some_symmetric_matrix<Dim>();
    const auto velocity = as_float4<Dim>(sample(set, [&](const Vec<Dim>& x) { return Vec<Dim>(G * x); }));
    std::size_t tested = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
      if (!is_interior<Dim>(set.position(i))) continue;
      ++tested;
      double morris = 0.0;
      double first_moment = 0.0;
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
        morris += morris_laplacian_weight(set.particles.volume[i], pairs.F(i, k), pairs.d(i, k).squaredNorm(), dx);
        first_moment -= set.particles.volume[i] * pairs.slope(i, k) * pairs.r(i, k) / Dim;
      }
      const double in_single = 10.0 * single_eps;
      const KernelValues values = kernel_values_of(kernel, dx);
      EXPECT_NEAR(kernel_sums<Dim>(pairs, i, values).concentration, sums.concentration, in_single);
      EXPECT_NEAR(morris, sums.morris, in_single * sums.morris);
      EXPECT_LT(kernel_sums<Dim>(pairs, i, values).gradient.norm() * dx, in_single);
      // By symmetry the two standard forms multiply linear fields by -sum w dW r/Dim and add nothing else.
      EXPECT_LT((conservative_gradient<Dim>(pairs, i, set.particles.volume, vectors, linear) -
                 first_moment * some_vector<Dim>())
                    .norm(),
                in_single);
      EXPECT_NEAR(standard_divergence<Dim>(pairs, i, vectors, velocity), first_moment * G.trace(), in_single);
    }
    EXPECT_GT(tested, 0u);
  }
}

}  // namespace exactness_test
}  // namespace tailwater
