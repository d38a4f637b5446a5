// Open ends: their warnings, and what they restore.
#include "open_ends/open_ends.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "case/reader.h"
#include "io/messages.h"
#include "published/make_flow.h"

namespace tailwater {
namespace {

/// A tank with one outlet, at which a level is prescribed.
Flow<2> flow_with_outlet() {
  const CaseSpec spec = read_case_text(
      "particles.spacing = 0.1\ntime.end = 1\n[[wall]]\npoints = [[0, 1], [0, 0], [2, 0]]\n[[fluid]]\nmin = [0, 0]\n"
      "max = [2, 0.5]\n[[outlet]]\nname = \"end\"\nfrom = [2, 0]\nto = [2, 1]\nlevel = 0.5\n",
      "case.toml");
  return make_flow<2>(spec);
}

/// The last warning at the end of a run whose outlet missed its level.
std::string warning_of(const LevelError& miss) {
  Flow<2> flow = flow_with_outlet();
  auto& ends = flow.part<OpenEnds<2>>();
  Json saved = ends.save();
  saved["states"][0]["miss"].update(
      {{"mean", miss.mean}, {"lasts", miss.lasts}, {"since", miss.since}, {"total", miss.total}, {"most", miss.most}});
  EXPECT_TRUE(ends.restore(saved));
  const std::size_t before = warnings().size();
  ends.warn_at_end(flow);
  return warnings().size() > before ? warnings().back() : "";
}

TEST(OpenEndsWarning, ReportsAtTheEndWhetherALevelIsHeldAgain) {
  EXPECT_EQ(warning_of({}), "");
  EXPECT_EQ(
      warning_of({.mean = -0.3, .lasts = 2.0, .since = 1.0, .total = 2.0, .most = -0.4}),
      "at t = 0 s the level at outlet 'end', not held for 2 s and off by 0.4 m at the most, is still 0.3 m too low");
  EXPECT_EQ(warning_of({.mean = 0.05, .lasts = 0.0, .since = 1.0, .total = 2.0, .most = 0.4}),
            "at t = 0 s the level at outlet 'end', not held for 2 s and off by 0.4 m at the most, is within a spacing "
            "again");
}

TEST(OpenEnds, StatesOfAnotherNumberOfEndsAreRejected) {
  Flow<2> flow = flow_with_outlet();
  auto& ends = flow.part<OpenEnds<2>>();
  Json saved = ends.save();
  EXPECT_TRUE(ends.restore(saved));
  saved["states"].push_back(saved["states"][0]);
  EXPECT_FALSE(ends.restore(saved));
}

}  // namespace
}  // namespace tailwater
