// Neighbour rows against brute force.
#include "neighbours/neighbourhood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include "base/z_curve.h"
#include "neighbours/pair_lanes.h"
#include "support/dimensions.h"
#include "support/particle_set.h"
#include "support/rounding.h"

namespace tailwater {
namespace {

constexpr double radius = 0.3;
constexpr double skin = 0.04;
constexpr double spacing = 0.1;

template <class D>
class NeighbourhoodTest : public testing::Test {};
TYPED_TEST_SUITE(NeighbourhoodTest, Dimensions);

/// Random fluid particles in the unit cube.
template <int Dim>
Particles<Dim> random_fluid(std::size_t count, std::uint64_t seed) {
  Noise noise(seed);
  std::vector<Vec<Dim>> positions(count);
  for (Vec<Dim>& position : positions) position = 0.5 * (noise.vector<Dim>() + Vec<Dim>::Ones());
  Particles<Dim> particles = fluid_at<Dim>(positions, spacing);
  for (Vec<Dim>& velocity : particles.velocity) velocity = noise.vector<Dim>();
  return particles;
}

template <int Dim>
Neighbourhood<Dim> make_neighbourhood(WallRows rows = WallRows::all, PeriodicDomain<Dim> domain = {}) {
  return Neighbourhood<Dim>(make_kernel<Dim>(KernelName::wendland_c2, radius), spacing, skin, rows, std::move(domain));
}

template <int Dim>
PeriodicDomain<Dim> unit_domain(int periodic_directions) {
  PeriodicDomain<Dim> domain;
  for (int d = 0; d < periodic_directions; ++d) domain[d] = std::pair{0.0, 1.0};
  return domain;
}

/// The owned particle that particle j is, or copies.
template <int Dim>
std::int32_t owner_of(const Neighbourhood<Dim>& neighbourhood, std::int32_t j) {
  const ExchangePlan& plan = neighbourhood.halo().plan;
  const auto ghost = static_cast<std::ptrdiff_t>(j) - static_cast<std::ptrdiff_t>(plan.owned());
  return ghost < 0 ? j : plan.sent()[ghost];
}

/// r_i - r_j of the nearest images.
template <int Dim>
Vec<Dim> separation(const PeriodicDomain<Dim>& domain, const Vec<Dim>& a, const Vec<Dim>& b) {
  Vec<Dim> difference = a - b;
  for (int d = 0; d < Dim; ++d) {
    if (domain[d]) difference[d] -= std::round(difference[d]);
  }
  return difference;
}

/// Every pair within the support is in the row once, with the right distance, direction and kernel; nothing is there
/// twice. With `exactly_to` the row holds just the pairs within that distance.
template <int Dim>
void expect_rows_hold_the_support(const Particles<Dim>& particles, const Neighbourhood<Dim>& neighbourhood,
                                  const PeriodicDomain<Dim>& domain = {}, double exactly_to = 0.0) {
  const Pairs<Dim>& pairs = neighbourhood.pairs();
  ASSERT_EQ(pairs.owned(), particles.owned);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    std::vector<int> found(particles.owned, 0);
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const std::int32_t j = owner_of(neighbourhood, pairs.j[k]);
      ++found[j];
      const Vec<Dim> r_ij = separation<Dim>(domain, particles.position[i], particles.position[j]);
      ASSERT_NEAR(pairs.r(i, k), r_ij.norm(), 8.0 * eps);  // coordinates of size 1
      ASSERT_LT((pairs.d(i, k) - r_ij).norm(), 8.0 * eps);
      // A few roundings of the distance, times the steepest slopes of W and F: some 3 W(0)/R and 60 W(0)/R^3.
      const double r = pairs.r(i, k);
      const double rounding = 16.0 * eps * kernel_value(neighbourhood.kernel(), 0.0);
      ASSERT_NEAR(pairs.value(i, k), kernel_value(neighbourhood.kernel(), r), rounding);
      ASSERT_NEAR(pairs.F(i, k), kernel_steepness(neighbourhood.kernel(), r),
                  20.0 * single_eps / eps * rounding / (radius * radius));
    }
    for (std::size_t j = 0; j < particles.owned; ++j) {
      ASSERT_LE(found[j], 1);
      const double r = separation<Dim>(domain, particles.position[i], particles.position[j]).norm();
      if (j != i && r < radius) {
        ASSERT_EQ(found[j], 1) << "pair " << i << ", " << j << " at distance " << r << " is missing";
      }
      if (exactly_to > 0.0 && std::abs(r - exactly_to) > 8.0 * eps) {
        ASSERT_EQ(found[j], j != i && r < exactly_to ? 1 : 0);
      }
    }
  }
}

TYPED_TEST(NeighbourhoodTest, RowsEqualBruteForce) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = random_fluid<Dim>(400, 1);
  auto neighbourhood = make_neighbourhood<Dim>();
  EXPECT_TRUE(neighbourhood.update(particles));
  expect_rows_hold_the_support<Dim>(particles, neighbourhood, {}, radius);
}

/// A lattice of edge radius / 3, as the cells have, whose places lie on their borders, and many particles in one cell.
/// Neighbours in space are far apart in memory.
template <int Dim>
Particles<Dim> lattice_and_clump() {
  constexpr int along = 5;
  constexpr std::size_t clump = 70;
  const std::size_t nodes = Dim == 2 ? along * along : along * along * along;
  const std::size_t count = nodes + clump;
  Noise noise(14);
  std::vector<Vec<Dim>> positions(count);
  for (std::size_t n = 0; n < count; ++n) {
    Vec<Dim>& position = positions[n * 7 % count];
    if (n < nodes) {
      std::size_t rest = n;
      for (int d = 0; d < Dim; ++d, rest /= along) position[d] = radius / 3.0 * static_cast<double>(rest % along);
    } else {
      position = Vec<Dim>::Constant(0.5 * radius) + 0.1 * radius * noise.vector<Dim>();
    }
  }
  return fluid_at<Dim>(positions, spacing);
}

TYPED_TEST(NeighbourhoodTest, RowsEqualBruteForceOnBordersOfCellsAndInFullCells) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = lattice_and_clump<Dim>();
  ASSERT_NE(particles.size() % 7, 0u) << "else some places were not given";
  auto neighbourhood = make_neighbourhood<Dim>();
  neighbourhood.update(particles);
  expect_rows_hold_the_support<Dim>(particles, neighbourhood, {}, radius);
}

TYPED_TEST(NeighbourhoodTest, GhostsServeUntilSomeoneMovedHalfTheSkin) {
  constexpr int Dim = TypeParam::value;
  for (const int periodic : {0, Dim}) {
    const PeriodicDomain<Dim> domain = unit_domain<Dim>(periodic);
    Particles<Dim> particles = random_fluid<Dim>(400, 2);
    auto neighbourhood = make_neighbourhood<Dim>(WallRows::all, domain);
    neighbourhood.update(particles);
    const auto start = particles.position;

    Noise noise(3);
    for (std::size_t i = 0; i < particles.owned; ++i) {
      particles.position[i] = start[i] + 0.499 * skin * noise.vector<Dim>().normalized();
    }
    EXPECT_FALSE(neighbourhood.update(particles));
    EXPECT_EQ(neighbourhood.renewals(), 1u);
    expect_rows_hold_the_support<Dim>(particles, neighbourhood, domain, radius);

    for (std::size_t i = 0; i < particles.owned; ++i) particles.position[i] = start[i];
    particles.position[7] += 0.501 * skin * Vec<Dim>::UnitX();
    const bool has_ghosts = periodic > 0;
    EXPECT_EQ(neighbourhood.update(particles), has_ghosts);
    EXPECT_EQ(neighbourhood.renewals(), has_ghosts ? 2u : 1u);
    if (!has_ghosts) expect_rows_hold_the_support<Dim>(particles, neighbourhood, domain, radius);
  }
}

TYPED_TEST(NeighbourhoodTest, PeriodicGhostsGiveTheMinimumImage) {
  constexpr int Dim = TypeParam::value;
  // The period 1 is more than twice the reach of 0.34, so the nearest image is the only one.
  for (int periodic = 1; periodic <= Dim; ++periodic) {
    const PeriodicDomain<Dim> domain = unit_domain<Dim>(periodic);
    Particles<Dim> particles = random_fluid<Dim>(400, 4);
    for (std::size_t i = 0; i < particles.owned; ++i) particles.pressure[i] = static_cast<double>(i);
    auto neighbourhood = make_neighbourhood<Dim>(WallRows::all, domain);
    neighbourhood.update(particles);
    expect_rows_hold_the_support<Dim>(particles, neighbourhood, domain, radius);
    for (std::size_t g = particles.owned; g < particles.size(); ++g) {
      const auto i = owner_of(neighbourhood, static_cast<std::int32_t>(g));
      EXPECT_EQ(particles.pressure[g], particles.pressure[i]);
      EXPECT_EQ(particles.velocity[g], particles.velocity[i]);
      EXPECT_EQ(particles.id[g], particles.id[i]);
    }
  }
}

TYPED_TEST(NeighbourhoodTest, ParticlesThatLeaveThePeriodicDomainKeepTheirNeighbours) {
  constexpr int Dim = TypeParam::value;
  const PeriodicDomain<Dim> domain = unit_domain<Dim>(Dim);
  // Inside a step a particle may be out by up to a skin: ghosts reach that far beyond the support. Farther out it must
  // be wrapped first, as every step begins.
  for (const double drift : {1.0, 5.0}) {
    Particles<Dim> particles = random_fluid<Dim>(400, 5);
    for (std::size_t i = 0; i < particles.owned; ++i) particles.position[i] += drift * skin * particles.velocity[i];
    auto neighbourhood = make_neighbourhood<Dim>(WallRows::all, domain);
    if (drift > 1.0) neighbourhood.wrap(particles);
    neighbourhood.update(particles);
    expect_rows_hold_the_support<Dim>(particles, neighbourhood, domain);
  }
}

TYPED_TEST(NeighbourhoodTest, WallsSeeOnlyFluidWhenAsked) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = random_fluid<Dim>(300, 6);
  for (std::size_t i = 0; i < particles.owned; i += i < 150 ? 1 : 3) particles.kind[i] = ParticleKind::wall;
  auto all = make_neighbourhood<Dim>(WallRows::all);
  auto fluid_only = make_neighbourhood<Dim>(WallRows::fluid_only);
  all.reorder(particles, ParticleOrder::z_curve);  // so that walls are searched for together
  all.update(particles);
  fluid_only.update(particles);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    std::vector<std::int32_t> expected;
    for (std::size_t k = all.pairs().begin(i); k < all.pairs().end(i); ++k) {
      const std::int32_t j = all.pairs().j[k];
      if (particles.is_fluid(i) || particles.is_fluid(j)) expected.push_back(j);
    }
    std::vector<std::int32_t> row(fluid_only.pairs().j.begin() + static_cast<long>(fluid_only.pairs().begin(i)),
                                  fluid_only.pairs().j.begin() + static_cast<long>(fluid_only.pairs().end(i)));
    std::sort(expected.begin(), expected.end());
    std::sort(row.begin(), row.end());
    ASSERT_EQ(row, expected);
  }
}

TYPED_TEST(NeighbourhoodTest, CoincidentParticlesGetOppositeDirections) {
  constexpr int Dim = TypeParam::value;
  const std::vector<Vec<Dim>> positions(2, Vec<Dim>::Constant(0.5));
  Particles<Dim> particles = fluid_at<Dim>(positions, spacing);
  auto neighbourhood = make_neighbourhood<Dim>();
  neighbourhood.update(particles);
  const Pairs<Dim>& pairs = neighbourhood.pairs();
  ASSERT_EQ(pairs.j.size(), 2u);
  EXPECT_EQ(pairs.e(0, 0), -pairs.e(1, 1));
  EXPECT_EQ(pairs.e(0, 0).norm(), 1.0);
  EXPECT_GT(pairs.r(0, 0), 0.0);
  EXPECT_EQ(pairs.r(0, 0), pairs.r(1, 1));
  EXPECT_LT(pairs.r(0, 0), 1e-3 * spacing);
  EXPECT_EQ(pairs.value(0, 0), pairs.value(1, 1));
  EXPECT_TRUE(std::isfinite(pairs.F(0, 0)));
}

TYPED_TEST(NeighbourhoodTest, RowsTellWhetherTheySeeAWall) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = random_fluid<Dim>(300, 13);
  for (std::size_t j = 0; j < particles.size(); ++j) {
    if (particles.position[j][0] < 0.1) particles.kind[j] = ParticleKind::wall;
  }
  Neighbourhood<Dim> neighbourhood = make_neighbourhood<Dim>();
  neighbourhood.update(particles);
  const Pairs<Dim>& pairs = neighbourhood.pairs();
  int rows_that_see = 0;
  for (std::size_t i = 0; i < pairs.owned(); ++i) {
    const bool sees = std::any_of(pairs.j.begin() + static_cast<std::ptrdiff_t>(pairs.begin(i)),
                                  pairs.j.begin() + static_cast<std::ptrdiff_t>(pairs.end(i)),
                                  [&](std::int32_t j) { return !particles.is_fluid(j); });
    EXPECT_EQ(pairs.sees_wall[i] != 0, sees);
    rows_that_see += sees ? 1 : 0;
  }
  EXPECT_GT(rows_that_see, 30);
  EXPECT_LT(rows_that_see, 270);
}

TYPED_TEST(NeighbourhoodTest, PlacesOfCoincidingParticlesArePartedByTheirIds) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = random_fluid<Dim>(300, 13);
  Neighbourhood<Dim> neighbourhood = make_neighbourhood<Dim>();
  const auto place = [&](std::size_t i) { return neighbourhood.pairs().place[i].at; };
  const std::array<std::size_t, 3> those_that_meet = {200, 7, 90};
  for (const double apart : {0.0, 0.4e-6 * spacing}) {  // both less than what counts as apart
    for (const std::size_t n : {1, 2}) {
      particles.position[those_that_meet[n]] =
          particles.position[200] + static_cast<double>(n) * apart * Vec<Dim>::UnitX();
    }
    neighbourhood.update(particles);
    const Pairs<Dim>& pairs = neighbourhood.pairs();
    const auto least = static_cast<std::uint32_t>(std::ceil(pairs.min_distance / pairs.unit[0]));
    ASSERT_GT(least, 10U);
    std::array<std::size_t, 3> by_id = those_that_meet;
    std::ranges::sort(by_id, {}, [&](std::size_t i) { return particles.id[i]; });
    for (std::size_t n = 1; n < by_id.size(); ++n) {
      EXPECT_EQ(place(by_id[n - 1])[0] - place(by_id[n])[0], least);
      for (int a = 1; a < Dim; ++a) EXPECT_EQ(place(by_id[n - 1])[a], place(by_id[n])[a]);
    }
    // Loops in lanes see two of them as loops pair by pair do.
    const std::size_t i = by_id[0];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      if (static_cast<std::size_t>(pairs.j[k]) != by_id[1]) continue;
      const VecLanes<Dim> d = one_pair(pairs, i, k).place().d;
      EXPECT_EQ(pairs.r(i, k), pairs.min_distance);
      for (int a = 0; a < Dim; ++a) EXPECT_NEAR(d.at[a][0], pairs.d(i, k)[a], 2.0 * pairs.unit[0]);
    }
  }
}

TYPED_TEST(NeighbourhoodTest, PairsKeepTheirGeometryWhenParticlesJump) {
  constexpr int Dim = TypeParam::value;
  const PeriodicDomain<Dim> domain = unit_domain<Dim>(1);
  Particles<Dim> particles = random_fluid<Dim>(200, 12);
  for (std::size_t i = 0; i < particles.owned; ++i) particles.position[i] += 0.9 * skin * particles.velocity[i];
  auto neighbourhood = make_neighbourhood<Dim>(WallRows::all, domain);
  neighbourhood.update(particles);
  const Pairs<Dim>& pairs = neighbourhood.pairs();
  const std::vector<Vec<Dim>> before = particles.position;
  neighbourhood.wrap(particles);  // as every step begins, while the pairs are those of the step before
  ASSERT_NE(particles.position, before);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      ASSERT_EQ(pairs.d(i, k), before[i] - before[pairs.j[k]]);
      ASSERT_LT(pairs.r(i, k), radius);
    }
  }
}

TYPED_TEST(NeighbourhoodTest, RowsHoldLowerIndicesThenHigherOnesThenGhostsEachInTheOrderOfTheGrid) {
  constexpr int Dim = TypeParam::value;
  constexpr std::size_t max_in_group = 32;  // those that are searched for with a particle have the order of indices
  Particles<Dim> particles = random_fluid<Dim>(400, 13);
  auto neighbourhood = make_neighbourhood<Dim>(WallRows::all, unit_domain<Dim>(Dim));
  for (const bool is_sorted : {false, true}) {  // sorted, many particles are searched for together
    if (is_sorted) neighbourhood.reorder(particles, ParticleOrder::z_curve);
    neighbourhood.update(particles);
    const Pairs<Dim>& pairs = neighbourhood.pairs();
    std::vector<std::size_t> place(particles.size());
    for (std::size_t n = 0; n < place.size(); ++n) place[neighbourhood.grid().order()[n]] = n;
    for (std::size_t i = 0; i < particles.owned; ++i) {
      int last_kind = 0;
      auto last_far = std::pair(-1, std::size_t{0});
      for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
        const auto j = static_cast<std::size_t>(pairs.j[k]);
        const int kind = static_cast<int>(j >= i) + static_cast<int>(j >= particles.owned);
        ASSERT_LE(last_kind, kind);
        last_kind = kind;
        const std::size_t apart = std::max(i, j) - std::min(i, j);
        if (apart < max_in_group) continue;
        ASSERT_LT(last_far, std::pair(kind, place[j]));
        last_far = {kind, place[j]};
      }
    }
  }
}

TYPED_TEST(NeighbourhoodTest, FarOutlierAndEmptySet) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = random_fluid<Dim>(200, 7);
  particles.position[100] = Vec<Dim>::Constant(-1e5);
  auto neighbourhood = make_neighbourhood<Dim>();
  neighbourhood.update(particles);
  EXPECT_EQ(neighbourhood.pairs().begin(100), neighbourhood.pairs().end(100));
  expect_rows_hold_the_support<Dim>(particles, neighbourhood, {}, radius);

  Particles<Dim> nobody;
  neighbourhood.update(nobody);
  EXPECT_EQ(neighbourhood.pairs().owned(), 0u);
}

/// Places are integers that repeat after 16 supports (Place). In the coarse cells that a distant particle asks for, a
/// search meets particles that far away.
TYPED_TEST(NeighbourhoodTest, ParticlesWhosePlacesRepeatAreNoNeighbours) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles = random_fluid<Dim>(200, 15);
  const std::size_t half = particles.owned / 2;
  for (std::size_t i = 0; i < half; ++i) {
    particles.kind[half + i] = i % 2 == 0 ? ParticleKind::fluid : ParticleKind::wall;
    particles.position[half + i] = particles.position[i] + 16.0 * radius * Vec<Dim>::Unit(i % Dim);
  }
  particles.position[0] = Vec<Dim>::Constant(1e6);
  auto neighbourhood = make_neighbourhood<Dim>();
  neighbourhood.update(particles);
  const Pairs<Dim>& pairs = neighbourhood.pairs();
  for (int d = 0; d < Dim; ++d) {
    ASSERT_LT(std::abs(static_cast<std::int32_t>(pairs.place[1].at[d] - pairs.place[half + 1].at[d])), 1000)
        << "in units of 2^-28 supports";
  }
  ASSERT_GT(neighbourhood.grid().reach(), 16.0 * radius);
  expect_rows_hold_the_support<Dim>(particles, neighbourhood, {}, radius);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const bool has_wall = std::any_of(pairs.j.begin() + static_cast<std::ptrdiff_t>(pairs.begin(i)),
                                      pairs.j.begin() + static_cast<std::ptrdiff_t>(pairs.end(i)),
                                      [&](std::int32_t j) { return !particles.is_fluid(j); });
    EXPECT_EQ(pairs.sees_wall[i] != 0, has_wall);
  }
}

/// Particles that `reorder` has sorted, after a check that they are those from before, inside the domain.
template <int Dim>
Particles<Dim> reordered(ParticleOrder order) {
  const PeriodicDomain<Dim> domain = unit_domain<Dim>(1);
  Particles<Dim> particles = random_fluid<Dim>(300, 8);
  Noise noise(9);
  for (std::size_t i = 0; i < particles.owned; ++i) {
    particles.pressure[i] = noise();
    particles.volume[i] = noise();
    particles.wall_row[i] = static_cast<std::int32_t>(3 * i);
    particles.kind[i] = i % 2 == 0 ? ParticleKind::fluid : ParticleKind::wall;
  }
  particles.position[5][0] = 1.25;
  particles.position[6][0] = -0.25;
  const Particles<Dim> before = particles;
  auto neighbourhood = make_neighbourhood<Dim>(WallRows::all, domain);
  neighbourhood.update(particles);
  neighbourhood.reorder(particles, order);

  EXPECT_EQ(particles.size(), before.owned);
  EXPECT_EQ(particles.owned, before.owned);
  std::set<std::int64_t> ids;
  for (std::size_t i = 0; i < particles.owned; ++i) {
    const auto id = static_cast<std::size_t>(particles.id[i]);  // was its place before
    ids.insert(particles.id[i]);
    Vec<Dim> position = before.position[id];
    if (id == 5) position[0] = 0.25;
    if (id == 6) position[0] = 0.75;
    EXPECT_EQ(particles.position[i], position);
    EXPECT_EQ(particles.velocity[i], before.velocity[id]);
    EXPECT_EQ(particles.pressure[i], before.pressure[id]);
    EXPECT_EQ(particles.volume[i], before.volume[id]);
    EXPECT_EQ(particles.kind[i], before.kind[id]);
    EXPECT_EQ(particles.wall_row[i], before.wall_row[id]);
  }
  EXPECT_EQ(ids.size(), before.owned);

  EXPECT_TRUE(neighbourhood.update(particles));
  expect_rows_hold_the_support<Dim>(particles, neighbourhood, domain, radius);
  return particles;
}

TYPED_TEST(NeighbourhoodTest, ReorderInSlabsPutsRowsOfCellsSideBySide) {
  constexpr int Dim = TypeParam::value;
  const Particles<Dim> particles = reordered<Dim>(ParticleOrder::slabs);
  const CellGrid<Dim> grid(std::span(particles.position).first(particles.owned), radius);
  EXPECT_TRUE(std::ranges::is_sorted(grid.order()));
}

TYPED_TEST(NeighbourhoodTest, ReorderAlongAZCurvePutsCellsOfCellsSideBySide) {
  constexpr int Dim = TypeParam::value;
  const Particles<Dim> particles = reordered<Dim>(ParticleOrder::z_curve);
  for (std::size_t i = 1; i < particles.owned; ++i) {
    for (const double edge : {spacing, 2.0 * spacing, 4.0 * spacing}) {
      EXPECT_LE(z_number<Dim>(particles.position[i - 1], edge), z_number<Dim>(particles.position[i], edge));
    }
  }
}

TYPED_TEST(NeighbourhoodTest, KeepTakesTheOthersOut) {
  constexpr int Dim = TypeParam::value;
  const PeriodicDomain<Dim> domain = unit_domain<Dim>(1);
  Particles<Dim> particles = random_fluid<Dim>(300, 10);
  const Particles<Dim> before = particles;
  auto neighbourhood = make_neighbourhood<Dim>(WallRows::all, domain);
  neighbourhood.update(particles);
  std::vector<std::int32_t> kept;
  for (std::int32_t i = 0; i < 300; i += 3) kept.push_back(i);
  neighbourhood.keep(particles, kept);

  ASSERT_EQ(particles.owned, 100u);
  ASSERT_EQ(particles.size(), 100u) << "no ghosts";
  for (std::size_t i = 0; i < particles.owned; ++i) {
    EXPECT_EQ(particles.id[i], before.id[3 * i]);
    EXPECT_EQ(particles.position[i], before.position[3 * i]);
  }
  EXPECT_TRUE(neighbourhood.update(particles));
  expect_rows_hold_the_support<Dim>(particles, neighbourhood, domain, radius);

  neighbourhood.keep(particles, {});
  EXPECT_TRUE(neighbourhood.update(particles));
  EXPECT_EQ(neighbourhood.pairs().owned(), 0u);
}

}  // namespace
}  // namespace tailwater
