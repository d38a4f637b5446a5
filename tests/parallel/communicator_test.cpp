#include "parallel/communicator.h"

#include <gtest/gtest.h>

#include <numeric>

namespace tailwater {
namespace {

const Communicator& world() {
  static const Communicator ranks = Communicator::world();
  return ranks;
}

TEST(Communicator, SumsAndExtremesAreThoseOfAllRanks) {
  const int n = world().size();
  const int r = world().rank();
  EXPECT_EQ(world().sum(std::int64_t{r + 1}), n * (n + 1) / 2);
  EXPECT_DOUBLE_EQ(world().sum(0.5 * r), 0.25 * n * (n - 1));
  EXPECT_EQ(world().largest(r), n - 1);
  EXPECT_EQ(world().least(2.0 - r), 3.0 - n);
  EXPECT_EQ(world().sum_before(r + 1), r * (r + 1) / 2);
}

TEST(Communicator, AnyIsTrueWhereverItIs) {
  for (int where = 0; where < world().size(); ++where) EXPECT_TRUE(world().any(world().rank() == where));
  EXPECT_FALSE(world().any(false));
}

TEST(Communicator, TransposeBringsEveryRankItsOwn) {
  std::vector<std::int64_t> counts(world().size());
  for (int q = 0; q < world().size(); ++q) counts[q] = 10 * world().rank() + q;
  const std::vector<std::int64_t> received = world().transpose(counts);
  for (int q = 0; q < world().size(); ++q) EXPECT_EQ(received[q], 10 * q + world().rank());
}

TEST(Communicator, ScatterIsTheInverseOfGather) {
  // Rank r has r values: the root none.
  std::vector<double> own(world().rank());
  std::iota(own.begin(), own.end(), 100.0 * world().rank());
  const auto counts = world().all_gather(static_cast<std::int64_t>(own.size()));
  EXPECT_EQ(world().scatter(world().gather(own), counts), own);
}

TEST(Communicator, GatherKeepsTheOrderOfRanksAndEmptyOnes) {
  // Rank r has r values: the root none.
  std::vector<double> own(world().rank());
  std::iota(own.begin(), own.end(), 100.0 * world().rank());
  std::vector<double> expected;
  for (int q = 0; world().is_root() && q < world().size(); ++q) {
    for (int k = 0; k < q; ++k) expected.push_back(100.0 * q + k);
  }
  EXPECT_EQ(world().gather(own), expected);

  const std::vector<std::string> texts = world().gather(std::string(world().rank(), 'x'));
  ASSERT_EQ(texts.size(), world().is_root() ? static_cast<std::size_t>(world().size()) : 0u);
  for (std::size_t q = 0; q < texts.size(); ++q) EXPECT_EQ(texts[q], std::string(q, 'x'));
}

TEST(Communicator, PartsOfAllRanksReachAllInTheirOrder) {
  const Communicator ranks = Communicator::world();
  std::vector<std::int64_t> own(static_cast<std::size_t>(2 * ranks.rank()), 10 + ranks.rank());  // none of the root's
  std::vector<int> counts;
  std::vector<std::int64_t> expected;
  for (int rank = 0; rank < ranks.size(); ++rank) {
    counts.push_back(2 * rank);
    expected.insert(expected.end(), static_cast<std::size_t>(2 * rank), 10 + rank);
  }
  EXPECT_EQ(ranks.all_gather(own, counts), expected);
}

TEST(Communicator, AllGatherAndBroadcastReachAllRanks) {
  const std::vector<int> all = world().all_gather(7 * world().rank());
  for (int q = 0; q < world().size(); ++q) EXPECT_EQ(all[q], 7 * q);
  for (int source = 0; source < world().size(); ++source) {
    const std::string own = "from " + std::to_string(world().rank());
    EXPECT_EQ(world().broadcast(own, source), "from " + std::to_string(source));
    EXPECT_EQ(world().broadcast("", source), "");
  }
}

}  // namespace
}  // namespace tailwater
