// Loops in lanes read and write what loops pair by pair do, in rows of any length.
#include "neighbours/pair_lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <vector>

namespace tailwater {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr std::size_t count = 23;

/// Particles in a unit box; the row of particle i has its i neighbours of lower index. The last two are at one place.
template <int Dim>
struct Rows {
  Rows() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    pairs.row_begin.push_back(0);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        pairs.j.push_back(static_cast<std::int32_t>(j));
        pairs.F.push_back(number(random));
      }
      pairs.row_begin.push_back(pairs.j.size());
      pairs.position.push_back(Vec<Dim>::NullaryExpr([&] { return number(random); }));
      pairs.id.push_back(static_cast<std::int64_t>(i));
      matrix.push_back(Mat<Dim>::NullaryExpr([&] { return number(random); }));
      volume.push_back(number(random));
      for (int m = 0; m < 4; ++m) records.push_back(number(random));
    }
    pairs.position[count - 1] = pairs.position[count - 2];
    pairs.least_distance = 1e-6;
  }

  std::vector<Mat<Dim>> matrix;
  std::vector<double> volume;
  std::vector<double> records;  // four numbers of each particle
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
  std::vector<int> visits(pairs.j.size(), 0);
  std::vector<Vec<Dim>> stored(pairs.j.size(), Vec<Dim>::Constant(7.0));
  std::vector<Vec<Dim>> expected(pairs.j.size());
  for (std::size_t i = 0; i < count; ++i) {
    for_each_lanes(pairs.begin(i), pairs.end(i), [&](auto range) {
      const LaneIndices j = range.neighbours(pairs.j.data());
      const VecLanes<Dim> d = differences<Dim>(pairs, range, j, i);
      const MatLanes<Dim> matrix = j(rows.matrix.data());
      const Lanes volume = j(rows.volume.data());
      const Lanes W = kernel_at(pairs, d);
      const Lanes F = range.load(pairs.F.data());
      const VecLanes<Dim> gradient = gradients(pairs, range, j, i);
      const std::array<Lanes, 4> record = j.template record<4>(rows.records.data());
      const Lanes even = j.where([](std::ptrdiff_t of) { return of % 2 == 0; }) ? in_all_lanes(1.0) : Lanes{};
      for (int n = 0; n < range.count; ++n) {
        const std::size_t k = range.begin + n;
        ++visits[k];
        expected[k] = pairs.d(i, k);
        EXPECT_NEAR(W[n], pairs.value(i, k), 16.0 * eps * kernel_value(pairs.kernel, 0.0));
        EXPECT_EQ(F[n], pairs.F[k]);
        for (int m = 0; m < 4; ++m) EXPECT_EQ(record[m][n], rows.records[4 * pairs.j[k] + m]);
        EXPECT_EQ(even[n], pairs.j[k] % 2 == 0 ? 1.0 : 0.0);
        EXPECT_EQ(volume[n], rows.volume[pairs.j[k]]);
        for (int a = 0; a < Dim; ++a) {
          EXPECT_EQ(d.at[a][n], expected[k][a]);
          EXPECT_EQ(gradient.at[a][n], -F[n] * d.at[a][n]);
          for (int b = 0; b < Dim; ++b) EXPECT_EQ(matrix.column[b].at[a][n], rows.matrix[pairs.j[k]](a, b));
        }
      }
      range.store(d, stored.data());
    });
  }
  EXPECT_EQ(expected.back().norm(), pairs.least_distance);
  for (std::size_t k = 0; k < visits.size(); ++k) {
    EXPECT_EQ(visits[k], 1);
    EXPECT_EQ(stored[k], expected[k]);
  }
}

TYPED_TEST(PairLanes, SumsLeaveOutTheLanesLeftOver) {
  constexpr int Dim = TypeParam::value;
  const Rows<Dim> rows;
  for (std::size_t i = 0; i < count; ++i) {
    Lanes lanes{};
    for_each_lanes(rows.pairs.begin(i), rows.pairs.end(i), [&](auto range) { lanes += range.only(in_all_lanes(1.0)); });
    EXPECT_EQ(sum_of(lanes), static_cast<double>(i));
  }
}

TEST(SymmetricLanes, AreReadAndSummedFromTheLowerTriangle) {
  const Mat<3> matrix{{1.0, -9.0, -9.0}, {2.0, 3.0, -9.0}, {4.0, 5.0, 6.0}};
  const MatLanes<3> lanes = LaneIndices([](int) { return 0; }).symmetric(&matrix);
  const Mat<3> symmetric{{1.0, 2.0, 4.0}, {2.0, 3.0, 5.0}, {4.0, 5.0, 6.0}};
  EXPECT_EQ(sum_of(lanes), Mat<3>(lane_count * symmetric));
  EXPECT_EQ(sum_of_lower(lanes), Mat<3>(lane_count * symmetric));
  const VecLanes<3> product = lanes.times({in_all_lanes(1.0), in_all_lanes(2.0), in_all_lanes(-1.0)});
  EXPECT_EQ(sum_of(product), Vec<3>(lane_count * symmetric * Vec<3>(1.0, 2.0, -1.0)));
}

}  // namespace
}  // namespace tailwater
