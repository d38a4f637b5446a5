// Warnings of a run about its own results.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/json.h"
#include "io/messages.h"
#include "results/crowding_watch.h"
#include "results/result_limits.h"
#include "support/pond.h"

namespace tailwater {
namespace {

/// A pond: energy rises as fractions of m g L/2, and the warnings that they cause.
class Limits {
 public:
  Limits() : flow_(make_flow<2>(pond_case<2>())), limits_(LimitsTable{}, flow_), before_(warnings().size()) {}

  /// Open ends and walls have done work, in the same unit.
  void rise_to(double share, double work_of_ends = 0.0, double work_of_walls = 0.0) {
    const double mass = fluid_sums_of_rank(flow_).mass;
    const double unit = 0.5 * mass * flow_.setup.gravity.norm() * flow_.setup.length;
    limits_.check(flow_.state.time, share * unit, work_of_ends * unit, work_of_walls * unit, {});
  }
  double rows() const { return flow_.setup.length / flow_.setup.scale.spacing; }
  ResultLimits& limits() { return limits_; }
  std::size_t count() const { return warnings().size() - before_; }

 private:
  Flow<2> flow_;
  ResultLimits limits_;
  std::size_t before_;
};

// A lift of all water by dx/20 takes 0.1 dx/L of m g L/2.
TEST(ResultLimits, IsSilentOfWhatTheLatticeDoesNotResolve) {
  Limits run;
  const double harmless = 0.1 / run.rows();
  run.rise_to(0.99 * harmless);
  EXPECT_EQ(run.count(), 0U);
  run.rise_to(1.01 * harmless);
  EXPECT_EQ(run.count(), 1U);
}

// A space that fills through an open end whose work is 20 times the initial energy.
TEST(ResultLimits, ComparesARiseWithTheWorkOfOpenEnds) {
  Limits run;
  run.rise_to(1.0, 20.0);
  run.limits().warn_of_largest();
  EXPECT_EQ(run.count(), 0U);
  run.rise_to(4.2, 20.0);
  ASSERT_EQ(run.count(), 1U);
  EXPECT_NE(warnings().back().find("by 20 %"), std::string::npos) << warnings().back();
}

// A piston that squeezes 20 rows was warned of 1.3 % of its own work, which the sum over its particles misses.
TEST(ResultLimits, AllowsTheErrorOfTheWorkOfWalls) {
  Limits run;
  run.rise_to(0.8, 0.0, 20.0);
  EXPECT_EQ(run.count(), 0U);
  run.rise_to(1.2 + 0.1 / run.rows(), 0.0, 20.0);
  EXPECT_EQ(run.count(), 1U);
}

TEST(ResultLimits, TellsInTheEndWhatTheEnergyRoseTo) {
  Limits run;
  run.rise_to(0.2);
  run.rise_to(33.0);
  ASSERT_EQ(run.count(), 1U);
  ResultLimits& limits = run.limits();
  const Json saved = limits.saved();
  limits.restore(saved);
  limits.warn_of_largest();
  ASSERT_EQ(run.count(), 2U);
  EXPECT_NE(warnings().back().find("3.3e+03 %"), std::string::npos) << warnings().back();
  limits.warn_of_largest();
  EXPECT_EQ(run.count(), 2U);
}

/// A pile of particles lasts; a jet that lands is dense for a few steps.
TEST(CrowdingWatch, WarnsOfAPileThatLastsAndNamesItsPlace) {
  Flow<2> flow = make_flow<2>(pond_case<2>());
  const std::size_t owned = flow.state.particles.owned;
  flow.role.assign(owned, Role::water);
  flow.surroundings.interior.assign(owned, 1.0);
  flow.surroundings.concentration.assign(owned, 1.0);
  flow.surroundings.concentration[3] = 3.2;
  flow.state.particles.position[3] = {0.125, 0.25};
  const std::size_t before = warnings().size();
  CrowdingWatch watch;
  for (int step = 0; step < 10; ++step) watch.check(flow, 2.2);
  for (int step = 0; step < 1000; ++step) watch.check(flow, 0.9);
  EXPECT_EQ(warnings().size(), before);
  for (int step = 0; step < 50; ++step) watch.check(flow, 2.2);
  ASSERT_EQ(warnings().size(), before + 1);
  EXPECT_NE(warnings().back().find("at (0.125, 0.25), where the density is 3.2 times"), std::string::npos)
      << warnings().back();
  CrowdingWatch resumed;
  resumed.restore(watch.saved());
  for (int step = 0; step < 50; ++step) resumed.check(flow, 2.2);
  EXPECT_EQ(warnings().size(), before + 1);
}

}  // namespace
}  // namespace tailwater
