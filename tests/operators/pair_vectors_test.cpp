// Properties of corrected pair vectors: antisymmetry for any set, first order on strained sets, half-closed faces.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "operators/divergence.h"
#include "operators/gradient_conservative.h"
#include "support/dimensions.h"
#include "support/pair_vectors.h"
#include "support/rounding.h"

namespace tailwater {
namespace pair_vectors_test {

constexpr double dx = 0.1;
constexpr double radius = 3.0 * dx;

template <class D>
class PairVectorsTest : public testing::Test {};
TYPED_TEST_SUITE(PairVectorsTest, Dimensions);

template <int Dim>
constexpr int cells = Dim == 2 ? 10 : 8;

/// A jittered lattice that fills a periodic box.
template <int Dim>
ParticleSet<Dim> periodic_set(double jitter) {
  PeriodicDomain<Dim> domain;
  const double half = 0.5 * cells<Dim> * dx;
  domain.fill(std::pair{-half, half});
  return ParticleSet<Dim>(jittered_cube<Dim>(cells<Dim>, dx, jitter), make_kernel<Dim>(KernelName::wendland_c2, radius),
                          dx, domain);
}

template <int Dim>
std::vector<Vec<Dim>> sums_over_faces(const ParticleSet<Dim>& set, const PairVectorField<Dim>& pair_vectors) {
  const std::vector<Vec<Dim>> vectors = listed(set.pairs(), pair_vectors);
  std::vector<Vec<Dim>> sums(set.pairs().owned());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i].setZero();
    for (std::size_t k = set.pairs().begin(i); k < set.pairs().end(i); ++k) {
      sums[i] += set.particles.volume[set.pairs().j[k]] * vectors[k];
    }
  }
  return sums;
}

TYPED_TEST(PairVectorsTest, AreAntisymmetricToTheLastBit) {
  constexpr int Dim = TypeParam::value;
  // A block with edges and arbitrary fractions of the corrections.
  const ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Noise noise(51);
  const auto interior =
      sample(set, [&](const Vec<Dim>& x) { return x.cwiseAbs().maxCoeff() < 2.0 * dx ? 0.5 + 0.5 * noise() : 0.0; });
  for (const CorrectionReach reach : {CorrectionReach::inside, CorrectionReach::surface}) {
    const Pairs<Dim>& pairs = set.pairs();
    const std::vector<Vec<Dim>> vectors = listed(pairs, corrected_pair_vectors<Dim>(set, interior, reach));
    std::size_t corrected = 0;
    for (std::size_t i = 0; i < pairs.owned(); ++i) {
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
        const auto j = static_cast<std::size_t>(pairs.j[k]);
        std::size_t back = pairs.begin(j);
        while (static_cast<std::size_t>(pairs.j[back]) != i) ++back;
        ASSERT_EQ(vectors[k], Vec<Dim>(-vectors[back]));
        corrected += (vectors[k] - pairs.gradient(i, k)).norm() > 100.0 * eps * vectors[k].norm();
      }
    }
    EXPECT_GT(corrected, reach == CorrectionReach::inside ? pairs.j.size() / 20 : pairs.j.size() / 2);
  }
}

TYPED_TEST(PairVectorsTest, TheMeanOfInteriorIsFoundOnTheWay) {
  constexpr int Dim = TypeParam::value;
  ParticleSet<Dim> set = jittered_block<Dim>(dx);
  Noise noise(52);
  const auto is_wall = [](const Vec<Dim>& x) { return x[0] < -2.0 * dx; };
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (is_wall(set.position(i))) set.particles.kind[i] = ParticleKind::wall;
  }
  set.neighbourhood.update(set.particles);
  const auto interior = sample(set, [&](const Vec<Dim>& x) { return is_wall(x) ? 0.0 : 0.5 + 0.5 * noise(); });
  const Pairs<Dim>& pairs = set.pairs();
  const std::vector<double> found = corrected_pair_vectors_and_faces<Dim>(set, interior).mean_interior;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (interior[i] == 0.0) continue;
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      const double weight = set.particles.is_fluid(j) ? pairs.value(i, k) : 0.0;
      sum += weight * interior[j];
      weights += weight;
    }
    ASSERT_NEAR(found[i], sum / weights, 16.0 * single_eps);
  }
}

TYPED_TEST(PairVectorsTest, AreTheKernelsGradientsWhereNothingIsInside) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set(jittered_cube<Dim>(7, dx, 0.3), make_kernel<Dim>(KernelName::wendland_c2, radius), dx);
  const Pairs<Dim>& pairs = set.pairs();
  const auto vectors = corrected_pair_vectors<Dim>(set, std::vector<double>(set.size(), 0.0));
  const auto gradients = kernel_gradients<Dim>(set);
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      EXPECT_EQ(vectors.at(pairs, i, k), gradients.at(pairs, i, k));
      EXPECT_LE((vectors.at(pairs, i, k) - pairs.gradient(i, k)).norm(),
                8.0 * single_eps * pairs.gradient(i, k).norm());
    }
  }
}

TYPED_TEST(PairVectorsTest, MomentumAndWorkAreExactAcrossPeriodicEdges) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = periodic_set<Dim>(0.3);
  const auto vectors = corrected_pair_vectors<Dim>(set, std::vector<double>(set.size(), 1.0));
  Noise noise(52);
  auto pressure = sample(set, [&](const Vec<Dim>&) { return noise(); });
  auto velocity = sample(set, [&](const Vec<Dim>&) { return noise.vector<Dim>(); });
  set.neighbourhood.halo().exchange(pressure, velocity);
  const std::vector<Float4> in_single = as_float4<Dim>(velocity);
  const std::vector<double>& volume = set.particles.volume;
  const Pairs<Dim>& pairs = set.pairs();
  Vec<Dim> force = Vec<Dim>::Zero();
  double work = 0.0;
  double terms = 0.0;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    const Vec<Dim> gradient = conservative_gradient<Dim>(pairs, i, set.particles.volume, vectors, pressure);
    force += volume[i] * gradient;
    work += volume[i] * velocity[i].dot(gradient);
    work += volume[i] * pressure[i] * standard_divergence<Dim>(pairs, i, vectors, in_single);
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      terms += 4.0 * std::sqrt(Dim) * volume[i] * volume[pairs.j[k]] * vectors.at(pairs, i, k).norm();
    }
  }
  // Positions of ghosts are rounded once more than those of their owners: some eps times the size of the box over the
  // spacing.
  const double round_off = static_cast<double>(pairs.owned() + 200) * eps * terms;
  EXPECT_LT(force.norm(), round_off);
  EXPECT_LT(std::abs(work), 4.0 * single_eps * terms);
}

TYPED_TEST(PairVectorsTest, AreOfFirstOrderOnAStrainedLattice) {
  constexpr int Dim = TypeParam::value;
  // A periodic lattice stretched by 1.2 along x and compressed along y.
  constexpr int count = 10;
  PeriodicDomain<Dim> domain;
  domain.fill(std::pair{-0.5 * count * dx, 0.5 * count * dx});
  std::vector<Vec<Dim>> points = jittered_cube<Dim>(count, dx, 0.0);
  for (const auto& [axis, stretch] : {std::pair{0, 1.2}, std::pair{1, 1.0 / 1.2}}) {
    for (Vec<Dim>& point : points) point[axis] *= stretch;
    domain[axis] = std::pair{-0.5 * count * dx * stretch, 0.5 * count * dx * stretch};
  }
  const ParticleSet<Dim> set(points, make_kernel<Dim>(KernelName::wendland_c2, radius), dx, domain);
  const auto vectors = corrected_pair_vectors<Dim>(set, std::vector<double>(set.size(), 1.0));
  const auto gradients = kernel_gradients<Dim>(set);
  Mat<Dim> G = Mat<Dim>::Constant(0.4);
  G(0, 0) = 1.0;
  G(1, 1) = -1.0;
  const Vec<Dim> slope = G.col(0);
  const auto velocity = as_float4<Dim>(sample(set, [&](const Vec<Dim>& x) { return Vec<Dim>(G * x); }));
  const auto pressure = sample(set, [&](const Vec<Dim>& x) { return slope.dot(x); });
  const Pairs<Dim>& pairs = set.pairs();
  const double bound = 100.0 * single_eps;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    EXPECT_LT((conservative_gradient<Dim>(pairs, i, set.particles.volume, vectors, pressure) - slope).norm(), bound);
    EXPECT_NEAR(standard_divergence<Dim>(pairs, i, vectors, velocity), G.trace(), bound);
    // With the kernel's gradients the strain appears as a compression.
    EXPECT_GT(std::abs(standard_divergence<Dim>(pairs, i, gradients, velocity) - G.trace()), 0.01);
  }
}

TYPED_TEST(PairVectorsTest, WhatTheyLeaveOpenOfTheFacesIsTheirSum) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = periodic_set<Dim>(0.2);
  Noise noise(53);
  auto interior = sample(set, [&](const Vec<Dim>& x) { return x[0] < 0.0 ? 0.0 : 0.5 + 0.5 * noise(); });
  set.neighbourhood.halo().exchange(interior);
  for (const CorrectionReach reach : {CorrectionReach::inside, CorrectionReach::surface}) {
    for (const int sweeps : {0, 1, closing_sweeps(reach)}) {
      const auto found = corrected_pair_vectors_and_faces<Dim>(set, interior, reach, sweeps);
      const auto sums = sums_over_faces<Dim>(set, found.vectors);
      for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool is_asked_for = reach == CorrectionReach::surface || interior[i] > 0.0;
        const Vec<Dim> expected = is_asked_for ? sums[i] : Vec<Dim>(Vec<Dim>::Zero());
        EXPECT_LT((found.open_faces[i] - expected).norm(), 10.0 * single_eps / dx);
      }
    }
  }
}

TYPED_TEST(PairVectorsTest, SweepsTendToHalfOfTheFaces) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = periodic_set<Dim>(0.2);
  const std::vector<double> inside(set.size(), 1.0);
  const auto open = sums_over_faces<Dim>(set, corrected_pair_vectors<Dim>(set, inside, CorrectionReach::inside, 0));
  const auto half_closed =
      sums_over_faces<Dim>(set, corrected_pair_vectors<Dim>(set, inside, CorrectionReach::inside, 400));
  const auto as_used = sums_over_faces<Dim>(set, corrected_pair_vectors<Dim>(set, inside));
  double squares_open = 0.0;
  double squares_used = 0.0;
  for (std::size_t i = 0; i < open.size(); ++i) {
    EXPECT_LT((half_closed[i] - 0.5 * open[i]).norm(), 10.0 * single_eps / dx);
    squares_open += open[i].squaredNorm();
    squares_used += as_used[i].squaredNorm();
  }
  // Closing half of each face leaves a quarter of the squares; three sweeps leave a little more.
  EXPECT_GT(squares_used, 0.25 * squares_open * (1.0 - 10.0 * single_eps));
  EXPECT_LT(squares_used, 0.5 * squares_open);
}

TYPED_TEST(PairVectorsTest, AtTheSurfaceSweepsTendToTheKernelsForceOfAUniformPressure) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set(jittered_cube<Dim>(6, dx, 0.2), make_kernel<Dim>(KernelName::wendland_c2, radius), dx);
  const std::vector<double> surface(set.size(), 0.0);
  const auto kernel = sums_over_faces<Dim>(set, kernel_gradients<Dim>(set));
  const auto sums_after = [&](int sweeps) {
    return sums_over_faces<Dim>(set, corrected_pair_vectors<Dim>(set, surface, CorrectionReach::surface, sweeps));
  };
  const auto found = sums_after(1000);
  const auto open = sums_after(0);
  double squares_open = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT((found[i] - kernel[i]).norm(), 10.0 * single_eps / dx);
    squares_open += (open[i] - kernel[i]).squaredNorm();
  }
  EXPECT_GT(squares_open, 1e-3 * static_cast<double>(found.size()) / (dx * dx));
}

TYPED_TEST(PairVectorsTest, StretchingOfASurfaceIsNoCompressionOnceTheyReachIt) {
  constexpr int Dim = TypeParam::value;
  // A block at rest; the middle of its top is a flat surface.
  constexpr int count = Dim == 2 ? 17 : 11;
  const ParticleSet<Dim> set(jittered_cube<Dim>(count, dx, 0.0), make_kernel<Dim>(KernelName::wendland_c2, radius), dx);
  const double top = 0.5 * (count - 1) * dx;
  const auto interior =
      sample(set, [&](const Vec<Dim>& x) { return x.cwiseAbs().maxCoeff() < top - 1.5 * dx ? 1.0 : 0.0; });
  const auto velocity = as_float4<Dim>(sample(set, [&](const Vec<Dim>& x) {
    Vec<Dim> u = Vec<Dim>::Zero();
    u[0] = x[0];
    u[Dim - 1] = -x[Dim - 1];
    return u;
  }));
  const auto divergences_on_top = [&](const PairVectorField<Dim>& vectors) {
    std::vector<double> found;  // 1/s, for the three outermost rows in the middle
    for (int row = 0; row < 3; ++row) {
      for (std::size_t i = 0; i < set.pairs().owned(); ++i) {
        Vec<Dim> place = Vec<Dim>::Zero();
        place[Dim - 1] = top - row * dx;
        if ((set.particles.position[i] - place).norm() > 0.1 * dx) continue;
        found.push_back(standard_divergence<Dim>(set.pairs(), i, vectors, velocity));
      }
    }
    return found;
  };
  const auto kernel = divergences_on_top(kernel_gradients<Dim>(set));
  const auto inside = divergences_on_top(corrected_pair_vectors<Dim>(set, interior));
  const auto surface = divergences_on_top(corrected_pair_vectors<Dim>(set, interior, CorrectionReach::surface));
  ASSERT_EQ(kernel.size(), 3u);
  for (int row = 0; row < 2; ++row) {
    EXPECT_GT(kernel[row], 0.1);
    EXPECT_NEAR(inside[row], kernel[row], 0.01);
    EXPECT_LT(std::abs(surface[row]), 0.3 * kernel[row]);
  }
  EXPECT_LT(std::abs(surface[2]), 0.2 * kernel[1]);  // due to the sweeps, which reach inside
}

}  // namespace pair_vectors_test
}  // namespace tailwater
