// Loops in lanes read and write what loops pair by pair do, in rows of any length, rounded to single precision.
#include "neighbours/pair_lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "neighbours/find_pairs.h"
#include "support/rounding.h"

namespace tailwater {
namespace {

constexpr std::size_t count = 23;

/// Sixteen numbers of a particle.
struct alignas(64) Sixteen {
  std::array<float, 16> at;
};

/// Particles in a unit box at `origin`, every third of them a wall; the row of particle i has its i neighbours of lower
/// index.
template <int Dim>
struct Rows {
  explicit Rows(double origin = 0.0) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    const auto single = [&] { return static_cast<float>(number(random)); };
    Particles<Dim> particles;
    particles.resize(count);
    pairs.row_begin.push_back(0);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) pairs.j.push_back(static_cast<std::int32_t>(j));
      pairs.row_begin.push_back(pairs.j.size());
      particles.position[i] = Vec<Dim>::NullaryExpr([&](int) { return origin + number(random); });
      particles.volume[i] = single();
      particles.kind[i] = i % 3 == 0 ? ParticleKind::wall : ParticleKind::fluid;
      pairs.id.push_back(static_cast<std::int64_t>(i));
      field.push_back(number(random));
      vectors.push_back(Vec<Dim>::NullaryExpr([&](int) { return number(random); }));
      records.emplace_back();
      for (float& value : records.back().at) value = single();
    }
    pairs.position = particles.position;
    volume = particles.volume;
    find_places<Dim>(particles, {}, 2.0, pairs);
  }

  std::vector<double> volume;
  std::vector<double> field;
  std::vector<Vec<Dim>> vectors;
  std::vector<Sixteen> records;
  Pairs<Dim> pairs;
};

template <class Dimension>
class PairLanes : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(PairLanes, Dimensions);

TYPED_TEST(PairLanes, EveryEntryIsInOneLane) {
  constexpr int Dim = TypeParam::value;
  const Rows<Dim> rows;
  const Pairs<Dim>& pairs = rows.pairs;
  ASSERT_EQ(pairs.j.size(), count * (count - 1) / 2);
  const std::vector<Float4> fours = as_float4<Dim>(rows.vectors);
  std::vector<int> visits(pairs.j.size(), 0);
  std::vector<float> stored(pairs.j.size() + lane_count, -1.0F);
  for (std::size_t i = 0; i < count; ++i) {
    for_each_pair(pairs, i, [&](const auto& batch) {
      const auto& range = batch.range;
      const PlaceLanes<Dim> place = batch.place();
      const Lanes W = batch.kernel_at(place.d);
      const Lanes F = batch.F(place.d);
      const std::array<Lanes, 16> record = batch.j.numbers(rows.records.data());
      const Lanes field = batch.of(rows.field);
      const VecLanes<Dim> vectors = batch.of(fours);
      const VecLanes<Dim> differences = vectors - fours[i];
      const Lanes fluid = place.of_fluid(in_all_lanes(1.0));
      const Lanes W_of_fluid = batch.kernel_of_fluid();
      for (int n = 0; n < range.count; ++n) {
        const std::size_t k = range.begin + n;
        const auto neighbour = pairs.j[k];
        const auto volume = static_cast<float>(rows.volume[neighbour]);
        const bool is_fluid = neighbour % 3 != 0;
        ++visits[k];
        EXPECT_NEAR(W[n], pairs.value(i, k), 16.0 * single_eps * kernel_value(pairs.kernel, 0.0));
        EXPECT_EQ(F[n], pairs.F(i, k));
        EXPECT_NEAR(F[n], kernel_steepness(pairs.kernel, pairs.r(i, k)),
                    64.0 * single_eps * kernel_value(pairs.kernel, 0.0));
        for (int m = 0; m < 16; ++m) EXPECT_EQ(record[m][n], rows.records[neighbour].at[m]);
        EXPECT_EQ(field[n], static_cast<float>(rows.field[neighbour]));
        EXPECT_EQ(place.volume()[n], volume);
        EXPECT_EQ(place.volume_of_fluid()[n], is_fluid ? volume : 0.0F);
        EXPECT_EQ(fluid[n], is_fluid ? 1.0F : 0.0F);
        EXPECT_EQ(W_of_fluid[n], is_fluid ? W[n] : 0.0F);
        for (int a = 0; a < Dim; ++a) {
          EXPECT_NEAR(place.d.at[a][n], pairs.d(i, k)[a], single_eps);
          EXPECT_EQ(vectors.at[a][n], static_cast<float>(rows.vectors[neighbour][a]));
          EXPECT_EQ(differences.at[a][n], vectors.at[a][n] - fours[i].at[a]);
        }
      }
      for (int n = range.count; n < lane_count; ++n) {  // what sums leave out
        EXPECT_EQ(F[n], 0.0F);
        EXPECT_EQ(place.volume()[n], 0.0F);
        EXPECT_EQ(fluid[n], 0.0F);
        EXPECT_EQ(W_of_fluid[n], 0.0F);
      }
      batch.store(F, stored.data() + pairs.begin(i));
    });
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      EXPECT_EQ(visits[k], 1);
      EXPECT_EQ(stored[k], pairs.F(i, k));
    }
  }
  for (std::size_t k = visits.size(); k < stored.size(); ++k) EXPECT_EQ(stored[k], -1.0F);
}

TYPED_TEST(PairLanes, WeightsMultiplyKernelAndGradientAndPairsOfWeightZeroAreRemoved) {
  constexpr int Dim = TypeParam::value;
  const Rows<Dim> rows;
  const Pairs<Dim>& whole = rows.pairs;
  Pairs<Dim> weighed = whole;
  weighed.sees_wall.assign(count, 1);
  const auto weight = [](std::size_t i, std::size_t j) { return static_cast<float>((i + j) % 4) / 4.0F; };
  weigh_pairs(
      weighed, [](std::size_t) { return false; }, [](std::size_t, std::size_t) { return 0.0F; });
  EXPECT_TRUE(weighed.weight.empty());
  weigh_pairs(
      weighed, [](std::size_t i) { return i >= 8; },
      [&](std::size_t i, std::size_t k) { return weight(i, whole.j[k]); });
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t left = weighed.begin(i);
    for (std::size_t k = whole.begin(i); k < whole.end(i); ++k) {
      const float of_pair = i >= 8 ? weight(i, whole.j[k]) : 1.0F;
      if (of_pair == 0.0F) continue;
      ASSERT_LT(left, weighed.end(i));
      EXPECT_EQ(weighed.j[left], whole.j[k]);
      EXPECT_EQ(weighed.value(i, left), of_pair * whole.value(i, k));
      EXPECT_EQ(weighed.F(i, left), of_pair * whole.F(i, k));
      ++left;
    }
    EXPECT_EQ(left, weighed.end(i));
  }
}

TYPED_TEST(PairLanes, DifferencesAreAsExactFarFromTheOriginAndOppositeForBothEnds) {
  constexpr int Dim = TypeParam::value;
  const Rows<Dim> rows(1e4);  // five thousand supports away: places have gone round 2^32 a thousand times
  const Pairs<Dim>& pairs = rows.pairs;
  Pairs<Dim> swapped = pairs;
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      swapped.j[k] = static_cast<std::int32_t>(i);
      const VecLanes<Dim> d = one_pair(pairs, i, k).place().d;
      const VecLanes<Dim> back = one_pair(swapped, j, k).place().d;
      for (int a = 0; a < Dim; ++a) {
        EXPECT_NEAR(d.at[a][0], pairs.d(i, k)[a], single_eps);
        EXPECT_EQ(d.at[a][0], -back.at[a][0]);
      }
    }
  }
}

TYPED_TEST(PairLanes, PeriodicImagesAreAsFarAwayAsTheirOwners) {
  constexpr int Dim = TypeParam::value;
  Particles<Dim> particles;
  particles.resize(2);
  particles.position = {Vec<Dim>::Constant(0.123456789), Vec<Dim>::Constant(0.123456789 + 1.7)};
  Pairs<Dim> pairs;
  PeriodicDomain<Dim> domain;
  domain.fill(std::pair{0.0, 1.7});
  find_places<Dim>(particles, domain, 0.3, pairs);
  const double period = std::round(1.7 / static_cast<float>(0.3 * 0x1p-28));
  for (int a = 0; a < Dim; ++a) {
    EXPECT_EQ(pairs.place[1].at[a] - pairs.place[0].at[a], static_cast<std::uint32_t>(std::llround(period)));
  }
}

TEST(LaneSums, AreInDoublePrecision) {
  LaneSum sum;
  Lanes lanes{};
  for (int n = 0; n < lane_count; ++n) {
    sum += in_all_lanes(n == 0 ? 0x1p24 : 1.0);
    lanes += in_all_lanes(1.0);
  }
  EXPECT_EQ(sum.total(), lane_count * (0x1p24 + lane_count - 1.0));
  EXPECT_EQ(sum_of(lanes), static_cast<double>(lane_count * lane_count));
}

TEST(MatrixLanes, AreAddedUpAndMultiplied) {
  const VecLanes<3> x{in_all_lanes(1.0), in_all_lanes(2.0), in_all_lanes(-1.0)};
  MatLanes<3> full{};
  SymmetricLanes<3> symmetric{};
  const Mat<3> expected{{1.0, 2.0, -1.0}, {2.0, 4.0, -2.0}, {-1.0, -2.0, 1.0}};  // x x, of rank one but with all signs
  for (int b = 0; b < 3; ++b) {
    for (int a = 0; a < 3; ++a) full.column[b].at[a] = in_all_lanes(expected(a, b));
  }
  symmetric.add(x, x);
  EXPECT_EQ(sum_of(full), Mat<3>(lane_count * expected));
  EXPECT_EQ(sum_of(symmetric), Mat<3>(lane_count * expected));
  for (int n = 0; n < 6; ++n) symmetric.packed[n] = in_all_lanes(n);  // no two entries alike
  const Mat<3> numbered{{0.0, 1.0, 2.0}, {1.0, 3.0, 4.0}, {2.0, 4.0, 5.0}};
  EXPECT_EQ(sum_of(symmetric), Mat<3>(lane_count * numbered));
  const Vec<3> y(1.0, 2.0, -1.0);
  EXPECT_EQ(sum_of(full.times(x)), Vec<3>(lane_count * expected * y));
  EXPECT_EQ(sum_of(symmetric.times(x)), Vec<3>(lane_count * numbered * y));
}

}  // namespace
}  // namespace tailwater
