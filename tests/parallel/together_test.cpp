#include "parallel/together.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace tailwater {
namespace {

template <class Error>
std::string message_on_rank(const Communicator& ranks, int rank) {
  try {
    do_together(ranks, [&] {
      if (ranks.rank() >= rank) throw Error("what rank " + std::to_string(ranks.rank()) + " says");
    });
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(DoTogether, AllRanksThrowWhatTheFirstOneThrows) {
  const Communicator ranks = Communicator::world();
  for (int rank = 0; rank < ranks.size(); ++rank) {
    const std::string expected = "what rank " + std::to_string(rank) + " says";
    EXPECT_EQ(message_on_rank<InputError>(ranks, rank), expected);
    EXPECT_EQ(message_on_rank<SolverError>(ranks, rank), expected);
    EXPECT_EQ(message_on_rank<IoError>(ranks, rank), expected);
  }
  EXPECT_NO_THROW(do_together(ranks, [] {}));
}

TEST(DoTogether, OnlyTheRootWorks) {
  const Communicator ranks = Communicator::world();
  int calls = 0;
  do_on_root(ranks, [&] { ++calls; });
  EXPECT_EQ(calls, ranks.is_root() ? 1 : 0);
  EXPECT_THROW(do_on_root(ranks, [] { throw InputError("no"); }), InputError);
}

}  // namespace
}  // namespace tailwater
