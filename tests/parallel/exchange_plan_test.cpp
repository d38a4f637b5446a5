#include "parallel/exchange_plan.h"

#include <gtest/gtest.h>

#include <numeric>

#include "base/vec.h"

namespace tailwater {
namespace {

/// Rank r owns 3 (r + 1) entries; the last of several ranks owns none. Each rank sends to every rank, itself included,
/// its entries k for which (k + sender + receiver) is even, the first of them twice.
struct Exchange {
  Communicator ranks = Communicator::world();
  std::size_t owned = owned_by(ranks.rank());
  ExchangePlan plan{ranks, owned, sent_by_rank()};

  std::size_t owned_by(int rank) const {
    return ranks.size() > 1 && rank == ranks.size() - 1 ? 0 : 3 * (static_cast<std::size_t>(rank) + 1);
  }
  std::vector<std::int32_t> message(int sender, int receiver) const {
    std::vector<std::int32_t> entries;
    for (std::int32_t k = 0; k < static_cast<std::int32_t>(owned_by(sender)); ++k) {
      if ((k + sender + receiver) % 2 == 0) entries.push_back(k);
    }
    if (!entries.empty()) entries.push_back(entries.front());
    return entries;
  }
  std::vector<std::vector<std::int32_t>> sent_by_rank() const {
    std::vector<std::vector<std::int32_t>> sent;
    for (int receiver = 0; receiver < ranks.size(); ++receiver) sent.push_back(message(ranks.rank(), receiver));
    return sent;
  }

  /// value(rank, k) for the owned entries.
  template <class Value>
  auto owned_field(const Value& value) const {
    std::vector<decltype(value(0, 0))> field;
    for (std::size_t k = 0; k < owned; ++k) field.push_back(value(ranks.rank(), static_cast<std::int32_t>(k)));
    return field;
  }
  /// The owned entries followed by the ghosts that must arrive.
  template <class Value>
  auto whole_field(const Value& value) const {
    auto field = owned_field(value);
    for (int sender = 0; sender < ranks.size(); ++sender) {
      for (const std::int32_t k : message(sender, ranks.rank())) field.push_back(value(sender, k));
    }
    return field;
  }
};

// No two entries, fields or components are equal.
double number(int rank, std::int32_t k) { return 1e6 * rank + k + 0.1; }
std::int64_t name(int rank, std::int32_t k) { return 5'000'000'000 * (rank + 1) + k; }
std::int32_t row(int rank, std::int32_t k) { return -1000 * rank - k; }
std::uint8_t mark(int rank, std::int32_t k) { return static_cast<std::uint8_t>(16 * rank + k); }
Vec<2> flat(int rank, std::int32_t k) { return {number(rank, k) + 0.2, number(rank, k) + 0.3}; }
Vec<3> solid(int rank, std::int32_t k) { return {number(rank, k), -number(rank, k), 0.5 * number(rank, k)}; }
Mat<3> tensor(int rank, std::int32_t k) { return solid(rank, k) * Vec<3>(1.0, 2.0, 3.0).transpose(); }

TEST(ExchangePlan, EveryFieldOfEveryTypeArrives) {
  const Exchange exchange;
  const auto arrives = [&](const auto& value) {
    auto field = exchange.owned_field(value);
    exchange.plan.exchange(field);
    EXPECT_EQ(field, exchange.whole_field(value));
  };
  arrives(number);
  arrives(name);
  arrives(row);
  arrives(mark);
  arrives(flat);
  arrives(solid);
  arrives(tensor);
}

TEST(ExchangePlan, SeveralFieldsGoInOneMessage) {
  const Exchange exchange;
  auto marks = exchange.owned_field(mark);
  auto numbers = exchange.owned_field(number);
  auto places = exchange.owned_field(solid);
  const Traffic* const traffic = exchange.ranks.traffic();
  const std::int64_t before = traffic ? traffic->messages : 0;
  exchange.plan.exchange(marks, numbers, places);
  EXPECT_EQ(marks, exchange.whole_field(mark));
  EXPECT_EQ(numbers, exchange.whole_field(number));
  EXPECT_EQ(places, exchange.whole_field(solid));
  if (traffic == nullptr) return;
  std::int64_t others = 0;
  for (int rank = 0; rank < exchange.ranks.size(); ++rank) {
    others += rank != exchange.ranks.rank() && !exchange.message(exchange.ranks.rank(), rank).empty();
  }
  EXPECT_EQ(traffic->messages - before, others);
}

TEST(ExchangePlan, ASecondExchangeBringsTheNewValues) {
  const Exchange exchange;
  auto field = exchange.owned_field(number);
  exchange.plan.exchange(field);
  for (std::size_t k = 0; k < exchange.owned; ++k) field[k] = -field[k];
  exchange.plan.exchange(field);
  EXPECT_EQ(field, exchange.whole_field([](int rank, std::int32_t k) { return -number(rank, k); }));
}

TEST(ExchangePlan, DeliversWhatIsNoCopyOfAnEntry) {
  const Exchange exchange;
  const int rank = exchange.ranks.rank();
  std::vector<double> packed;
  for (int receiver = 0; receiver < exchange.ranks.size(); ++receiver) {
    for (const std::int32_t k : exchange.message(rank, receiver)) packed.push_back(number(rank, k) + 1000.0 * receiver);
  }
  ASSERT_EQ(packed.size(), exchange.plan.sent().size());
  auto field = exchange.owned_field(number);
  exchange.plan.deliver(std::span<const double>(packed), field);
  auto expected = exchange.whole_field(number);
  for (std::size_t k = exchange.owned; k < expected.size(); ++k) expected[k] += 1000.0 * rank;
  EXPECT_EQ(field, expected);
}

TEST(ExchangePlan, NothingToSendIsFine) {
  const Communicator ranks = Communicator::world();
  const ExchangePlan plan(ranks, 2, std::vector<std::vector<std::int32_t>>(ranks.size()));
  std::vector<double> field{1.0, 2.0, 3.0};
  plan.exchange(field);
  EXPECT_EQ(field, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(plan.ghosts(), 0u);
}

}  // namespace
}  // namespace tailwater
