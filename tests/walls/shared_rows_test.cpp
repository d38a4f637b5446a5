// Rows of walls among ranks: each at home on one rank, and also on ranks with particles that need it.
#include "walls/shared_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/dimensions.h"

namespace tailwater {
namespace {

constexpr std::int64_t resting = 1000;
constexpr std::int64_t first_id = 70;

/// Properties of the row with this number; every seventh number belongs to a position without a particle.
bool exists(std::int64_t number) { return number % 7 != 3; }
bool moves(std::int64_t number) { return number >= 400 && number < 420; }

/// The rows that a rank has made, in a mixed order. They are all rows of a wall that moves, and those of the other
/// wall, at 1 m per number, in the rank's part of space.
template <int Dim>
Walls<Dim> made_by(const Communicator& ranks) {
  Walls<Dim> walls;
  walls.boundary.walls = {{.name = "bed"}, {.name = "gate", .body = 1}};
  walls.particles.numbers = resting;
  walls.is_curved = true;
  for (std::int64_t k = 0; k < resting; ++k) {
    const std::int64_t number = k * 377 % resting;
    if (!exists(number) || !(moves(number) || number % ranks.size() == ranks.rank())) continue;
    const auto x = static_cast<double>(number);
    walls.particles.position.push_back(x * Vec<Dim>::UnitX());
    walls.particles.normal.push_back(Vec<Dim>::UnitY());
    walls.particles.blocked.push_back(x * Mat<Dim>::Identity());
    walls.particles.beyond_edges.push_back(-x * Mat<Dim>::Identity());
    walls.particles.share.push_back(2.0 * x);
    walls.particles.wall.push_back(moves(number) ? 1 : 0);
    walls.particles.is_beyond_end.push_back(0);
    walls.particles.number.push_back(number);
    walls.friction.push_back(3.0 * x);
    walls.roughness.push_back(4.0 * x);
    walls.depth.push_back(5.0 * x);
    walls.curvature.push_back(6.0 * x * Mat<Dim>::Identity());
    walls.normal_in_gap.push_back(7.0 * x * Vec<Dim>::UnitX());
  }
  return walls;
}

template <int Dim>
void expect_row(const Walls<Dim>& walls, std::int32_t row, std::int64_t number) {
  const auto x = static_cast<double>(number);
  ASSERT_GE(row, 0) << number;
  EXPECT_EQ(walls.particles.number[row], number);
  EXPECT_EQ(walls.particles.position[row], Vec<Dim>(x * Vec<Dim>::UnitX()));
  EXPECT_EQ(walls.particles.normal[row], Vec<Dim>(Vec<Dim>::UnitY()));
  EXPECT_EQ(walls.particles.blocked[row], Mat<Dim>(x * Mat<Dim>::Identity()));
  EXPECT_EQ(walls.particles.beyond_edges[row], Mat<Dim>(-x * Mat<Dim>::Identity()));
  EXPECT_EQ(walls.particles.share[row], 2.0 * x);
  EXPECT_EQ(walls.particles.wall[row], moves(number) ? 1 : 0);
  EXPECT_EQ(walls.friction[row], 3.0 * x);
  EXPECT_EQ(walls.roughness[row], 4.0 * x);
  EXPECT_EQ(walls.depth[row], 5.0 * x);
  EXPECT_EQ(walls.curvature[row], Mat<Dim>(6.0 * x * Mat<Dim>::Identity()));
  EXPECT_EQ(walls.normal_in_gap[row], Vec<Dim>(7.0 * x * Vec<Dim>::UnitX()));
}

/// Wall particles with these numbers, behind one fluid particle.
template <int Dim>
Particles<Dim> particles_of(const std::vector<std::int64_t>& numbers) {
  Particles<Dim> particles;
  particles.resize(numbers.size() + 1);
  particles.owned = particles.size();
  particles.kind[0] = ParticleKind::fluid;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    particles.kind[k + 1] = ParticleKind::wall;
    particles.id[k + 1] = first_id + numbers[k];
  }
  return particles;
}

/// Different numbers on every rank, some on several.
std::vector<std::int64_t> numbers_on(int rank) {
  std::vector<std::int64_t> numbers;
  for (std::int64_t number = 31 * rank; number < 31 * rank + 420; number += 3) {
    if (exists(number)) numbers.push_back(number);
  }
  return numbers;
}

template <class D>
class SharedRowsTest : public testing::Test {
 protected:
  Communicator ranks = Communicator::world();
  Walls<D::value> walls = made_by<D::value>(ranks);
  SharedRows<D::value> rows{ranks, walls};
};
TYPED_TEST_SUITE(SharedRowsTest, Dimensions);

TYPED_TEST(SharedRowsTest, AreEachAtHomeOnOneRankAndMovingOnesOnAll) {
  std::int64_t all_moving = 0;
  std::int64_t all = 0;
  for (std::int64_t number = 0; number < resting; ++number) {
    all += exists(number) ? 1 : 0;
    all_moving += exists(number) && moves(number) ? 1 : 0;
  }
  EXPECT_EQ(this->walls.all, all);
  EXPECT_EQ(static_cast<std::int64_t>(this->walls.moving), all_moving);
  EXPECT_EQ(this->walls.kept, this->walls.particles.size());
  EXPECT_LE(static_cast<std::int64_t>(this->walls.kept - this->walls.moving), all / this->ranks.size() + 1);
  std::vector<int> copies(resting, 0);
  for (std::size_t row = 0; row < this->walls.kept; ++row) {
    const std::int64_t number = this->walls.particles.number[row];
    expect_row<TypeParam::value>(this->walls, static_cast<std::int32_t>(row), number);
    EXPECT_EQ(row < this->walls.moving, moves(number));
    copies[number] = 1;
  }
  std::vector<double> sums(copies.begin(), copies.end());
  this->ranks.sum_of_each(sums);
  for (std::int64_t number = 0; number < resting; ++number) {
    const int expected = !exists(number) ? 0 : moves(number) ? this->ranks.size() : 1;
    EXPECT_EQ(sums[number], expected) << number;
  }
}

TYPED_TEST(SharedRowsTest, ComeWhereAParticleNeedsThemAndGoWhenNoneDoes) {
  constexpr int Dim = TypeParam::value;
  const std::vector<std::int64_t> numbers = numbers_on(this->ranks.rank());
  Particles<Dim> particles = particles_of<Dim>(numbers);
  ASSERT_TRUE(this->rows.find_rows(this->walls, particles, 0, first_id));
  const auto expect_all = [&] {
    EXPECT_EQ(particles.wall_row[0], -1);
    for (std::size_t k = 1; k < particles.owned; ++k) {
      expect_row<Dim>(this->walls, particles.wall_row[k], particles.id[k] - first_id);
    }
  };
  expect_all();
  const std::size_t most = this->walls.particles.size();
  // Ghosts: the particles of the next rank. Only the rows of ghosts are searched.
  const std::vector<std::int64_t> others = numbers_on((this->ranks.rank() + 1) % this->ranks.size());
  for (const std::int64_t number : others) {
    particles.resize(particles.size() + 1);
    particles.kind.back() = ParticleKind::wall;
    particles.id.back() = first_id + number;
  }
  ASSERT_TRUE(this->rows.find_rows(this->walls, particles, particles.owned, first_id));
  for (std::size_t k = 0; k < others.size(); ++k) {
    expect_row<Dim>(this->walls, particles.wall_row[particles.owned + k], others[k]);
  }
  expect_all();
  particles.resize(particles.owned);
  this->rows.drop_halo_rows(this->walls, particles);
  EXPECT_EQ(this->walls.particles.size(), most);
  expect_all();
  // Half of the particles remain.
  particles.resize(particles.owned / 2);
  particles.owned = particles.size();
  this->rows.drop_halo_rows(this->walls, particles);
  expect_all();
  if (!this->ranks.is_alone()) {
    EXPECT_LT(this->ranks.sum(this->walls.particles.size()), this->ranks.sum(most));
  }
  particles.resize(1);
  particles.owned = 1;
  this->rows.drop_halo_rows(this->walls, particles);
  EXPECT_EQ(this->walls.particles.size(), this->walls.kept);
}

TYPED_TEST(SharedRowsTest, AreHandedOut) {
  constexpr int Dim = TypeParam::value;
  const int size = this->ranks.size();
  const int next = (this->ranks.rank() + 1) % size;
  std::vector<std::vector<std::int32_t>> sent(static_cast<std::size_t>(size));
  if (next != this->ranks.rank()) sent[next].push_back(static_cast<std::int32_t>(this->walls.moving));
  const std::size_t first = this->rows.hand_out(this->walls, sent);
  EXPECT_EQ(first, this->walls.kept);
  EXPECT_EQ(this->walls.particles.size(), this->walls.kept + (size > 1 ? 1 : 0));
  for (std::size_t row = first; row < this->walls.particles.size(); ++row) {
    const std::int64_t number = this->walls.particles.number[row];
    expect_row<Dim>(this->walls, static_cast<std::int32_t>(row), number);
    Particles<Dim> particles = particles_of<Dim>({number});
    // The row is on this rank, so no rank needs to request it; the call is still collective.
    EXPECT_TRUE(this->rows.find_rows(this->walls, particles, 0, first_id));
    EXPECT_EQ(particles.wall_row[1], static_cast<std::int32_t>(row));
  }
}

TYPED_TEST(SharedRowsTest, AreNotFoundWhereNoneIs) {
  Particles<TypeParam::value> particles = particles_of<TypeParam::value>({this->ranks.is_root() ? 10 : 11});
  EXPECT_FALSE(exists(10));
  EXPECT_FALSE(this->rows.find_rows(this->walls, particles, 0, first_id));
}

}  // namespace
}  // namespace tailwater
