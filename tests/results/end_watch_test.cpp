// What a run tells of open ends that do not do what they should.
#include "results/end_watch.h"

#include <gtest/gtest.h>

#include <string>

#include "case/reader.h"
#include "io/messages.h"
#include "published/make_flow.h"

namespace tailwater {
namespace {

/// What is told in the end of an outlet whose level was missed.
std::string told_of(const LevelError& miss) {
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 1\n[[wall]]\npoints = [[0, 1], [0, 0], [2, 0]]\n[[fluid]]\nmin = [0, 0]\n"
      "max = [2, 0.5]\n[[outlet]]\nname = \"end\"\nfrom = [2, 0]\nto = [2, 1]\nlevel = 0.5\n",
      "case.toml");
  Flow<2> flow = make_flow<2>(spec);
  flow.state.open_ends.at(0).miss = miss;
  const std::size_t before = warnings().size();
  OpenEndMonitor().warn_of_end(flow);
  return warnings().size() > before ? warnings().back() : "";
}

TEST(OpenEndMonitor, TellsInTheEndWhetherALevelIsHeldAgain) {
  EXPECT_EQ(told_of({}), "");
  EXPECT_EQ(
      told_of({.mean = -0.3, .lasts = 2.0, .since = 1.0, .total = 2.0, .most = -0.4}),
      "at t = 0 s the level at outlet 'end', not held for 2 s and off by 0.4 m at the most, is still 0.3 m too low");
  EXPECT_EQ(told_of({.mean = 0.05, .lasts = 0.0, .since = 1.0, .total = 2.0, .most = 0.4}),
            "at t = 0 s the level at outlet 'end', not held for 2 s and off by 0.4 m at the most, is within a spacing "
            "again");
}

}  // namespace
}  // namespace tailwater
