#include "parallel/space_cuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/dimensions.h"
#include "support/particle_set.h"

namespace tailwater {
namespace {

constexpr std::size_t points_in_all = 8000;

/// Points in a unit cube with weights from 1 to 3, the same for any number of ranks. They are dealt round-robin to all
/// ranks but the last, which starts with none.
template <int Dim>
struct Cloud {
  Communicator ranks = Communicator::world();
  std::vector<Vec<Dim>> all;
  std::vector<double> all_weights;
  std::vector<Vec<Dim>> own;
  std::vector<double> own_weights;

  Cloud() {
    Noise noise(7);
    const int holders = std::max(1, ranks.size() - 1);
    for (std::size_t i = 0; i < points_in_all; ++i) {
      all.push_back(noise.vector<Dim>());
      all_weights.push_back(2.0 + noise());
      if (static_cast<int>(i % holders) == ranks.rank()) {
        own.push_back(all.back());
        own_weights.push_back(all_weights.back());
      }
    }
  }
};

template <class Dimension>
class SpaceCutsTest : public testing::Test {};
TYPED_TEST_SUITE(SpaceCutsTest, Dimensions);

/// A cut passes between points. The weight of a part is therefore off by up to the weight of one point at each of its
/// cuts, or by the tolerance given to Zoltan, 1 %.
TYPED_TEST(SpaceCutsTest, PartsGetEqualWeight) {
  constexpr int Dim = TypeParam::value;
  const Cloud<Dim> cloud;
  SpaceCuts<Dim> cuts(cloud.ranks);
  cuts.cut(cloud.own, cloud.own_weights);
  std::vector<double> weight(cloud.ranks.size(), 0.0);
  double total = 0.0;
  for (std::size_t i = 0; i < cloud.all.size(); ++i) {
    weight[cuts.part_of(cloud.all[i])] += cloud.all_weights[i];
    total += cloud.all_weights[i];
  }
  const double share = total / cloud.ranks.size();
  for (const double part : weight) EXPECT_NEAR(part, share, 0.01 * share + 2.0 * 3.0);
}

TYPED_TEST(SpaceCutsTest, RanksAgreeAlsoAboutFarPlaces) {
  constexpr int Dim = TypeParam::value;
  const Cloud<Dim> cloud;
  Noise noise(11);
  std::vector<Vec<Dim>> places = cloud.all;
  for (int i = 0; i < 2000; ++i) places.push_back(3.0 * noise.vector<Dim>());
  for (int i = 0; i < 100; ++i) places.push_back(1e3 * noise.vector<Dim>());
  SpaceCuts<Dim> cuts(cloud.ranks);
  EXPECT_FALSE(cuts.are_made());
  cuts.cut(cloud.own, cloud.own_weights);
  std::int64_t disagreements = 0;
  for (const Vec<Dim>& place : places) {
    const int part = cuts.part_of(place);
    ASSERT_GE(part, 0);
    ASSERT_LT(part, cloud.ranks.size());
    disagreements += part != cloud.ranks.largest(part);
  }
  EXPECT_EQ(disagreements, 0);
}

/// Restored cuts are equal, and so are the next ones, although bisection starts from the previous cuts.
TYPED_TEST(SpaceCutsTest, CanBeSavedAndRestored) {
  constexpr int Dim = TypeParam::value;
  Cloud<Dim> cloud;
  const auto expect_same = [&](const SpaceCuts<Dim>& a, const SpaceCuts<Dim>& b) {
    for (const Vec<Dim>& place : cloud.all) ASSERT_EQ(a.part_of(place), b.part_of(place));
  };
  SpaceCuts<Dim> cuts(cloud.ranks);
  cuts.cut(cloud.own, cloud.own_weights);
  for (double& weight : cloud.own_weights) weight = 1.0 / weight;
  cuts.cut(cloud.own, cloud.own_weights);
  SpaceCuts<Dim> restored(cloud.ranks);
  if (cloud.ranks.is_alone()) return;
  restored.restore(cuts.bytes());
  EXPECT_TRUE(restored.are_made());
  expect_same(cuts, restored);
  for (std::size_t i = 0; i < cloud.own.size(); ++i) cloud.own_weights[i] = 2.0 + cloud.own[i][0];
  cuts.cut(cloud.own, cloud.own_weights);
  restored.cut(cloud.own, cloud.own_weights);
  expect_same(cuts, restored);
}

/// Recursive bisection cuts space by planes. Every part is a box, and a far position straight out from a face of the
/// cloud belongs to the part of the nearest point of the cloud.
TYPED_TEST(SpaceCutsTest, PartsOfBisectionAreBoxesWithoutBound) {
  constexpr int Dim = TypeParam::value;
  const Cloud<Dim> cloud;
  SpaceCuts<Dim> cuts(cloud.ranks);
  cuts.cut(cloud.own, cloud.own_weights);
  for (const Vec<Dim>& x : cloud.all) {
    for (int d = 0; d < Dim; ++d) {
      if (std::abs(x[d]) < 0.999) continue;
      Vec<Dim> far = x;
      far[d] = 50.0 * x[d];
      EXPECT_EQ(cuts.part_of(far), cuts.part_of(x));
    }
  }
}

}  // namespace
}  // namespace tailwater
