#include "results/progress.h"

#include <gtest/gtest.h>

namespace tailwater {
namespace {

TEST(ReadableDuration, ChangesUnitsWhereTheNextOneIsFull) {
  EXPECT_EQ(readable_duration(0.0), "under 1 s");
  EXPECT_EQ(readable_duration(0.49), "under 1 s");
  EXPECT_EQ(readable_duration(0.51), "1 s");
  EXPECT_EQ(readable_duration(12.4), "12 s");
  EXPECT_EQ(readable_duration(59.4), "59 s");
  EXPECT_EQ(readable_duration(59.6), "1 min 00 s");
  EXPECT_EQ(readable_duration(200.0), "3 min 20 s");
  EXPECT_EQ(readable_duration(3599.6), "1 h 00 min");
  EXPECT_EQ(readable_duration(3720.0), "1 h 02 min");
  EXPECT_EQ(readable_duration(48 * 3600 - 1), "47 h 59 min");
  EXPECT_EQ(readable_duration(48 * 3600), "2 days");
  EXPECT_EQ(readable_duration(4.5 * 86400), "4.5 days");
}

TEST(ReadableDuration, StaysShortHoweverLongItTakes) { EXPECT_EQ(readable_duration(86400e200), "1e+200 days"); }

TEST(ProgressLine, TellsWhatIsLeftFromWhatWasDone) {
  StepReport report;
  report.dt = 2e-3;
  report.passes = 3;
  report.iterations = 17;
  report.residual = 4e-6;
  FlowMeasures measures;
  measures.density_error_largest = 0.2;  // that of a single particle, which is not representative
  measures.density_error_rms = 0.0123;
  measures.density_error_mean = -0.0004;
  // A quarter took 60 s, so the other three quarters take 180 s.
  EXPECT_EQ(
      progress_line(0.5, 2.0, 60.0, 250, report, measures),
      " 25.0 %  t = 0.5000 s  ETA 3 min 00 s  step 250  dt 2.00e-03 s  passes 3  iterations 17  residual 4.0e-06  "
      "density error 1.23 % rms, -0.04 % mean");
}

TEST(ProgressLine, HasNoEstimateAtTheStartAndNoMoreThanAllAtTheEnd) {
  EXPECT_TRUE(progress_line(0.0, 2.0, 1.0, 0, {}, {}).starts_with("  0.0 %  t = 0.0000 s  ETA ?  "));
  EXPECT_TRUE(progress_line(2.1, 2.0, 1.0, 9, {}, {}).starts_with("100.0 %  t = 2.1000 s  ETA under 1 s  "));
}

}  // namespace
}  // namespace tailwater
