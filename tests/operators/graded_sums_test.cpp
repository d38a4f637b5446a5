// Sums over a set of particles of two spacings, as a zone of refinement places them at the start.
#include <gtest/gtest.h>

#include <cmath>

#include "operators/concentration.h"
#include "operators/graded_sums.h"
#include "operators/gradient_conservative.h"
#include "support/dimensions.h"
#include "support/particle_set.h"

namespace tailwater {
namespace {

constexpr double dx = 0.1;
constexpr double radius = 3.0 * dx;

/// A zone from x = 0 on, whose border ends at x = 4 dx.
template <int Dim>
SpacingField<Dim> field_of_face(int level = 1) {
  CaseSpec spec;
  spec.general.dimension = Dim;
  spec.particles.spacing = dx;
  RefinementTable zone;
  zone.min.assign(Dim, -50.0);
  zone.max.assign(Dim, 50.0);
  zone.min[0] = 0.0;
  zone.level = level;
  spec.refinement = {zone};
  return SpacingField<Dim>(spec, Boundary<Dim>{});
}

/// A block of the case's lattice around the border, divided where the field asks for it.
template <int Dim>
ParticleSet<Dim> graded_block(const SpacingField<Dim>& field) {
  std::array<int, Dim> count;
  count.fill(9);
  count[0] = 20;
  Vec<Dim> low = Vec<Dim>::Constant(-4.0 * dx);
  low[0] = -7.5 * dx;
  std::vector<Vec<Dim>> positions;
  std::vector<double> volumes;
  for (const Vec<Dim>& cell : lattice_points<Dim>(low, count, dx)) {
    divide_cell<Dim>(field, dx, cell, Vec<Dim>::Constant(dx), [&](const Vec<Dim>& centre, const Vec<Dim>& edges) {
      positions.push_back(centre);
      volumes.push_back(edges.prod());
    });
  }
  Particles<Dim> particles = fluid_at<Dim>(positions, dx);
  particles.volume = volumes;
  return ParticleSet<Dim>(std::move(particles), make_kernel<Dim>(KernelName::wendland_c2, radius), dx, {}, field);
}

/// Whether nothing of the support of particle i is missing.
template <int Dim>
bool is_full(const ParticleSet<Dim>& set, std::size_t i) {
  const Vec<Dim>& x = set.position(i);
  for (int axis = 1; axis < Dim; ++axis) {
    if (std::abs(x[axis]) > 4.5 * dx - radius) return false;
  }
  return x[0] > -8.0 * dx + radius && x[0] < 12.0 * dx - radius;
}

template <class D>
class GradedSumsTest : public testing::Test {};
TYPED_TEST_SUITE(GradedSumsTest, Dimensions);

TYPED_TEST(GradedSumsTest, ConcentrationIsOneAcrossABorder) {
  constexpr int Dim = TypeParam::value;
  const SpacingField<Dim> field = field_of_face<Dim>();
  const ParticleSet<Dim> set = graded_block<Dim>(field);
  const Kernel<Dim>& kernel = set.neighbourhood.kernel();
  const GradedSums<Dim> reference(kernel, dx, field);
  const KernelValues values{kernel_value(kernel, 0.0), kernel_value(kernel, dx)};
  double largest = 0.0;
  double largest_of_lattice = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!is_full(set, i)) continue;
    const double C = kernel_sums<Dim>(set.pairs(), i, values).concentration;
    const double C_0 = reference.lattice(set.pairs().relative_spacing_of(i), set.particles.volume[i]).concentration;
    const double expected = reference.continuum(set.position(i)).concentration;
    largest = std::max(largest, std::abs(C / (C_0 * expected) - 1.0));
    largest_of_lattice = std::max(largest_of_lattice, std::abs(C / C_0 - 1.0));
  }
  // The rest is the error of the quadrature on a set that is no lattice where volumes change: up to 2.5 % of C where
  // cells of two sizes meet. The supports alone change C by more.
  EXPECT_LT(largest, 0.03);
  EXPECT_GT(largest_of_lattice, 1.2 * largest);
}

TYPED_TEST(GradedSumsTest, TheTableOfAFaceIsTheQuadrature) {
  constexpr int Dim = TypeParam::value;
  const SpacingField<Dim> field = field_of_face<Dim>();
  CaseSpec spec;
  spec.particles.spacing = dx;
  RefinementTable zone;
  zone.min.assign(Dim, -50.0);
  zone.max.assign(Dim, 50.0);
  zone.min[0] = 0.0;
  spec.refinement = {zone, zone};  // twice the same: the general case
  const Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, radius);
  const GradedSums<Dim> table(kernel, dx, field);
  const GradedSums<Dim> quadrature(kernel, dx, SpacingField<Dim>(spec, Boundary<Dim>{}));
  for (double x = -4.0 * dx; x < 8.0 * dx; x += 0.31 * dx) {
    const Vec<Dim> place = x * Vec<Dim>::Unit(0);
    EXPECT_NEAR(table.continuum(place).concentration, quadrature.continuum(place).concentration, 2e-4) << x;
    EXPECT_NEAR(dx * (table.continuum(place).gradient - quadrature.continuum(place).gradient).norm(), 0.0, 2e-4) << x;
  }
}

TYPED_TEST(GradedSumsTest, PairsOfSeveralSpacingsAreSymmetric) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = graded_block<Dim>(field_of_face<Dim>());
  const Pairs<Dim>& pairs = set.pairs();
  PairVectorField<Dim> vectors;
  find_kernel_gradients(pairs, vectors);
  std::size_t graded = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      graded += pairs.relative_spacing_of(i) != pairs.relative_spacing_of(j) ? 1 : 0;
      std::size_t back = pairs.begin(j);
      while (back < pairs.end(j) && static_cast<std::size_t>(pairs.j[back]) != i) ++back;
      ASSERT_LT(back, pairs.end(j)) << "each is a neighbour of the other";
      ASSERT_EQ(vectors.at(pairs, i, k), -vectors.at(pairs, j, back));
    }
  }
  EXPECT_GT(graded, set.size());
}

TYPED_TEST(GradedSumsTest, RowsHoldTheSupportOfBothParticles) {
  constexpr int Dim = TypeParam::value;
  const ParticleSet<Dim> set = graded_block<Dim>(field_of_face<Dim>(2));
  const Pairs<Dim>& pairs = set.pairs();
  for (std::size_t i = 0; i < set.size(); i += 7) {
    std::size_t expected = 0;
    for (std::size_t j = 0; j < set.size(); ++j) {
      const double reach = 0.5 * radius * (pairs.relative_spacing_of(i) + pairs.relative_spacing_of(j));
      const double r = (set.position(i) - set.position(j)).norm();
      if (std::abs(r - reach) < 1e-5 * radius) expected = set.size() * 2;  // on the rim: either
      expected += j != i && r < reach ? 1 : 0;
    }
    if (expected >= set.size()) continue;
    EXPECT_EQ(pairs.end(i) - pairs.begin(i), expected);
  }
}

}  // namespace
}  // namespace tailwater
