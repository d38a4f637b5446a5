// Entry point of the test programs for several ranks: all ranks run all tests; a test that fails on one rank has
// failed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/fp_traps.h"
#include "linear/session.h"
#include "parallel/communicator.h"

namespace tailwater {
namespace {

/// Prints failures of ranks other than the root.
class ShowFailures : public testing::EmptyTestEventListener {
 public:
  explicit ShowFailures(int rank) : rank_(rank) {}
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (!result.failed()) return;
    fmt::print("rank {}: {}:{}: {}\n", rank_, result.file_name() ? result.file_name() : "", result.line_number(),
               result.message());
  }

 private:
  int rank_;
};

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) {
  using namespace tailwater;
  testing::InitGoogleTest(&argc, argv);
  const LinearSession session;
  const Communicator ranks = Communicator::world();
  if (!ranks.is_root()) {
    testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new ShowFailures(ranks.rank()));
  }
  enable_fp_traps();
  return ranks.any(RUN_ALL_TESTS() != 0) ? 1 : 0;
}
