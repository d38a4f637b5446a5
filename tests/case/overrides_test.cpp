#include <gtest/gtest.h>

#include "case_file.h"

namespace tailwater {
namespace {

const std::string two_blocks =
    "[parameters]\nH = 1.0\n"
    "[particles]\nspacing = 0.1\n[time]\nend = 1.0\n"
    "[[fluid]]\nmin = [0, 0]\nmax = [\"2*H\", \"H\"]\n"
    "[[fluid]]\nname = \"drop\"\nmin = [5, 5]\nmax = [6, 6]\n"
    "[[probe]]\nname = \"foot\"\ntype = \"energy\"\n";

TEST(Overrides, ReplaceValues) {
  const CaseSpec spec = read_text(two_blocks, {"particles.spacing=0.05", "time.end=2*H"});
  EXPECT_EQ(spec.particles.spacing, 0.05);
  EXPECT_EQ(spec.time.end, 2.0);
}

TEST(Overrides, OfParametersReachTheirExpressions) {
  EXPECT_EQ(read_text(two_blocks, {"parameters.H=0.5"}).fluid[0].max, (Coordinates{1.0, 0.5}));
}

TEST(Overrides, MakeTablesThatTheFileDoesNotHave) {
  const CaseSpec spec = read_text(two_blocks, {"scheme.integrator=implicit", "pressure_solver.max_iterations=7"});
  EXPECT_EQ(spec.scheme.integrator, Integrator::implicit_projection);
  EXPECT_EQ(spec.pressure_solver.max_iterations, 7);
}

TEST(Overrides, TakeWhatIsNotTomlAsText) {
  EXPECT_EQ(read_text(two_blocks, {"case.title=a wave, and another"}).general.title, "a wave, and another");
  EXPECT_EQ(read_text(two_blocks, {"case.title=\"in quotes\""}).general.title, "in quotes");
  EXPECT_EQ(read_text(two_blocks, {"case.title=x=y"}).general.title, "x=y");
  EXPECT_EQ(read_text(two_blocks, {"fluid[1].max=[6*min(1, 2), 7]"}).fluid[1].max, (Coordinates{6.0, 7.0}));
}

TEST(Overrides, FindEntriesOfListsByNumber) {
  const CaseSpec spec = read_text(two_blocks, {"fluid[1].max=[7, 8]", "fluid[0].max[1]=3"});
  EXPECT_EQ(spec.fluid[1].max, (Coordinates{7.0, 8.0}));
  EXPECT_EQ(spec.fluid[0].max, (Coordinates{2.0, 3.0}));
}

TEST(Overrides, FindEntriesOfListsByTheirOwnOrDefaultName) {
  const CaseSpec spec =
      read_text(two_blocks, {"probe.foot.interval=0.01", "fluid.drop.max=[7, 8]", "fluid.fluid1.max=[3, 3]"});
  EXPECT_EQ(spec.probes[0].interval, 0.01);
  EXPECT_EQ(spec.fluid[1].max, (Coordinates{7.0, 8.0}));
  EXPECT_EQ(spec.fluid[0].max, (Coordinates{3.0, 3.0}));
}

TEST(Overrides, ApplyInTheirOrder) { EXPECT_EQ(read_text(two_blocks, {"time.end=2", "time.end=3"}).time.end, 3.0); }

TEST(Overrides, ThatAreWrongAreNamed) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> table{
      {"time.end=-1", {"--set time.end=-1: time.end = -1: ", "above 0"}},
      {"time.ende=1", {"--set time.ende=1: time.ende", "did you mean \"end\"?"}},
      {"scheme.integrator=implict", {"--set scheme.integrator=implict:", "did you mean \"implicit\"?"}},
      {"particles.spacing=0.1 m", {"--set particles.spacing=0.1 m:", "without a unit"}},
      {"fluid[2].max=[1, 2]", {"fluid has 2 entries", "[2]"}},
      {"fluid[x].max=[1, 2]", {"\"[x]\" is not an index of a list"}},
      {"fluid[-1].max=[1, 2]", {"\"[-1]\" is not an index of a list"}},
      {"fluid[0.max=[1, 2]", {"bracket is not closed"}},
      {"fluid[0]max=1", {"\"max\" follows a bracket"}},
      {"probe.hand.interval=1", {"no probe named \"hand\"", "valid: \"foot\""}},
      {"fluid.max=[1, 2]", {"fluid is a list", "fluid[0].max"}},
      {"time[0]=1", {"time is not a list"}},
      {"time.end.x=1", {"end is not a table"}},
      {"scheme.courant", {"write --set table.key=value"}},
      {"=1", {"a name is missing"}},
      {"scheme.=1", {"a name is missing"}},
      {"courant=0.1", {"courant = 0.1: unknown table; it belongs to [scheme]"}},
      {"parameters.Hh=0.1", {"no parameter \"Hh\"", "did you mean \"H\"?"}},
  };
  for (const auto& [override_text, parts] : table) {
    const std::string message = message_of(two_blocks, {override_text});
    EXPECT_EQ(line_count(message), 1) << message;
    EXPECT_TRUE(message.starts_with("--set " + override_text + ": ")) << message;
    for (const std::string& part : parts) {
      EXPECT_NE(message.find(part), std::string::npos) << override_text << ": " << message << "\nmisses: " << part;
    }
  }
}

}  // namespace
}  // namespace tailwater
