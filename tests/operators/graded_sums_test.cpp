// Sums over a set of particles of two spacings, as a zone of refinement places them at the start.
#include <gtest/gtest.h>

#include <cmath>

#include "case/spec.h"
#include "geometry/boundary.h"
#include "operators/concentration.h"
#include "operators/continuum_table.h"
#include "operators/divergence.h"
#include "operators/graded_sums.h"
#include "operators/gradient_conservative.h"
#include "operators/support_operators.h"
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
  const KernelValues values = kernel_values_of(kernel, dx);
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

/// The fraction of a support of relative radius h that is filled at a depth behind a plane surface, by a sum over
/// points.
template <int Dim>
double filled_behind_surface(const Kernel<Dim>& kernel, double depth, double h) {
  constexpr int points = 40;  // along the radius
  constexpr double step = radius / points;
  double inside = 0.0;
  double all = 0.0;
  const int last_z = Dim == 3 ? points : 0;
  for (int c = -last_z; c <= last_z; ++c) {
    for (int b = -points; b <= points; ++b) {
      for (int a = -points; a < points; ++a) {
        const double across = (a + 0.5) * step;
        const double r = std::hypot(across, b * step, c * step);
        if (r >= h * radius) continue;
        all += kernel_value(kernel, r / h);
        if (across < depth) inside += kernel_value(kernel, r / h);
      }
    }
  }
  return inside / all;
}

TYPED_TEST(GradedSumsTest, TheChangeAtASurfaceIsThatOfALargerSupport) {
  constexpr int Dim = TypeParam::value;
  const Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, radius);
  const GradedSums<Dim> sums(kernel, dx, field_of_face<Dim>());
  EXPECT_EQ(sums.change_at_surface(0.4), 0.0);
  EXPECT_EQ(sums.change_at_surface(1.01), 0.0);
  for (const double depth : {0.1 * radius, 0.25 * radius, 0.5 * radius}) {
    constexpr double step = 0.01;
    const double smaller = filled_behind_surface<Dim>(kernel, depth, 1.0 - step);
    const double larger = filled_behind_surface<Dim>(kernel, depth, 1.0);
    const double change = (smaller - larger) / step;
    EXPECT_NEAR(sums.change_at_surface(0.5 * (smaller + larger)), change, 0.02 * change);
  }
}

TYPED_TEST(GradedSumsTest, TheTableIsTheQuadrature) {
  constexpr int Dim = TypeParam::value;
  const Kernel<Dim> kernel = make_kernel<Dim>(KernelName::wendland_c2, radius);
  const GradedSums<Dim> sums(kernel, dx, field_of_face<Dim>());
  ContinuumTable<Dim> table;
  for (double along = -4.0 * dx; along < 8.0 * dx; along += 0.31 * dx) {
    const Vec<Dim> x = Vec<Dim>::Constant(0.7) + along * Vec<Dim>::Unit(0);
    const auto entry = table.at(sums, x);
    const ContinuumSums<Dim> quadrature = sums.continuum(x);
    // C* bends by less than 0.04/dx^2, which leaves an eighth of it times the square of the distance of the nodes.
    EXPECT_NEAR(entry.sums.concentration, quadrature.concentration, 3e-4) << x;
    EXPECT_NEAR(dx * (entry.sums.gradient - quadrature.gradient).norm(), 0.0, 1e-3) << x;
    const double step = 0.05 * dx;
    const double behind = sums.continuum(x + step * Vec<Dim>::Unit(0)).concentration;
    const double before = sums.continuum(x - step * Vec<Dim>::Unit(0)).concentration;
    EXPECT_NEAR(dx * entry.slope[0], dx * (behind - before) / (2.0 * step), 5e-3) << x;
  }
}

/// C/c of a set, and the terms of its supports.
template <int Dim>
std::vector<double> filled_shares(const ParticleSet<Dim>& set, const GradedSums<Dim>& sums, SupportTerms<Dim>& terms) {
  const Kernel<Dim>& kernel = set.neighbourhood.kernel();
  const KernelValues values = kernel_values_of(kernel, dx);
  const std::vector<std::uint8_t> takes_part(set.size(), 1);
  find_references<Dim>(set.pairs(), sums, set.particles.volume, takes_part, 1.0, terms);
  std::vector<double> shares(set.size());
  terms.delta.resize(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    shares[i] = kernel_sums<Dim>(set.pairs(), i, values).concentration / terms.reference[i];
    terms.delta[i] = find_delta<Dim>(set.pairs(), i, shares[i], values.W_0, terms);
  }
  return shares;
}

TYPED_TEST(GradedSumsTest, TheDivergenceIsTheRateOfTheFilledShare) {
  constexpr int Dim = TypeParam::value;
  const SpacingField<Dim> field = field_of_face<Dim>();
  ParticleSet<Dim> set = graded_block<Dim>(field);
  const GradedSums<Dim> sums(set.neighbourhood.kernel(), dx, field);
  Noise noise(3);
  std::vector<Vec<Dim>> velocity(set.size());
  for (Vec<Dim>& u : velocity) u = noise.vector<Dim>();
  const std::vector<Float4> in_single = as_float4<Dim>(velocity);
  SupportTerms<Dim> terms;
  PairVectorField<Dim> vectors;
  find_kernel_gradients(set.pairs(), vectors);
  filled_shares(set, sums, terms);
  std::vector<double> divergence(set.size());
  std::vector<double> without(set.size());
  std::vector<std::uint8_t> counts(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    counts[i] = is_full(set, i) && terms.is_near_border(i);
    without[i] = standard_divergence<Dim>(set.pairs(), i, vectors, in_single);
    divergence[i] =
        terms.ends[i].inverse_reference *
        (without[i] - support_divergence<Dim>(set.pairs(), i, terms, in_single) - terms.delta[i].dot(velocity[i]));
  }
  const double time = 1e-3 * dx;
  std::array<std::vector<double>, 2> shares;  // a little before and after
  for (int n = 0; n < 2; ++n) {
    Particles<Dim> moved = set.particles;
    for (std::size_t i = 0; i < set.size(); ++i) moved.position[i] += (n == 0 ? -time : time) * velocity[i];
    shares[n] =
        filled_shares(ParticleSet<Dim>(std::move(moved), set.neighbourhood.kernel(), dx, {}, field), sums, terms);
  }
  double squares = 0.0;
  double errors = 0.0;
  double errors_without = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (counts[i] == 0) continue;
    const double rate = (shares[1][i] - shares[0][i]) / (2.0 * time);
    squares += rate * rate;
    errors += std::pow(rate + divergence[i], 2);
    errors_without += std::pow(rate + without[i], 2);
  }
  EXPECT_LT(errors, 1e-4 * squares);  // the rest: C* between nodes, differences in single precision
  EXPECT_GT(errors_without, 10.0 * errors);
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
