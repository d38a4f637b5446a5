// Differences between computed and measured curves, for curves with known differences.
#include "results/measurements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/json.h"
#include "case/reader.h"
#include "io/run_folder.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

constexpr double pi = std::numbers::pi;

Curve sampled(const std::function<double(double)>& value, double end, int count) {
  Curve curve;
  for (int k = 0; k <= count; ++k) {
    curve.time.push_back(end * k / count);
    curve.value.push_back(value(curve.time.back()));
  }
  return curve;
}

double wave(double time) { return std::sin(2.0 * pi * time); }

MeasurementTable measured(const Curve& curve, double shift, double scatter) {
  MeasurementTable table;
  table.probe = "gauge";
  table.column = "connected";
  table.file = "/lab/gauge.csv";
  table.shift = shift;
  table.scatter = scatter;
  table.series = {"gauge.csv", std::vector<int>(curve.time.size(), 1), curve.time, {curve.value}};
  return table;
}

TEST(Curve, IsLinearBetweenSamplesAndRestsBeyond) {
  const Curve curve{{1.0, 2.0, 4.0}, {0.0, 2.0, -2.0}};
  EXPECT_EQ(curve.at(0.0), 0.0);
  EXPECT_DOUBLE_EQ(curve.at(1.25), 0.5);
  EXPECT_DOUBLE_EQ(curve.at(3.0), 0.0);
  EXPECT_EQ(curve.at(9.0), -2.0);
}

TEST(MeasurementScore, OfAnOffsetIsItsRmsAndBias) {
  const MeasurementScore found =
      score(measured(sampled(wave, 3.0, 300), 0.0, 0.1), sampled([](double t) { return wave(t) - 0.02; }, 3.0, 3000));
  EXPECT_EQ(found.samples, 301u);
  EXPECT_NEAR(found.as_timed.rms, 0.02, 1e-4);
  EXPECT_NEAR(found.as_timed.bias, -0.02, 1e-4);
  EXPECT_TRUE(found.is_inside());
  EXPECT_EQ(found.shifted.share_inside, 1.0);
  EXPECT_EQ(found.best_shift, 0.0);
}

TEST(MeasurementScore, OfASineThatIsLateIsItsShift) {
  for (const double late : {0.07, -0.04}) {
    const MeasurementScore found = score(measured(sampled(wave, 3.0, 300), 0.1, 0.05),
                                         sampled([late](double t) { return wave(t - late); }, 4.0, 4000));
    // sin a - sin (a - b) has the rms 2 sin(b/2)/sqrt(2) over whole periods.
    EXPECT_NEAR(found.as_timed.rms, std::sqrt(2.0) * std::abs(std::sin(pi * late)), 1e-3);
    EXPECT_NEAR(found.best_shift, late, 0.0021);  // shifts are tried in steps of a thousandth
    EXPECT_LT(found.shifted.rms, 0.03);           // before t = 0 nothing is computed
    EXPECT_TRUE(found.is_inside());
    EXPECT_LT(found.as_timed.share_inside, 0.5);
  }
}

TEST(MeasurementScore, KeepsToTheShiftThatIsAllowed) {
  const MeasurementScore found =
      score(measured(sampled(wave, 3.0, 300), 0.03, 0.0), sampled([](double t) { return wave(t - 0.1); }, 4.0, 4000));
  EXPECT_DOUBLE_EQ(found.best_shift, 0.03);
  EXPECT_FALSE(found.is_inside());  // no scatter is known
  EXPECT_NE(found.words().find("all that is allowed"), std::string::npos) << found.words();
}

TEST(MeasurementScore, WeighsSamplesByTheTimeTheyStandFor) {
  // A hundred samples in the first tenth of a second have only the weight of that tenth.
  Curve lab = sampled([](double) { return 1.0; }, 0.1, 100);
  lab.time.push_back(1.0);
  lab.value.push_back(0.0);
  const Difference found = difference(lab, {{0.0, 2.0}, {0.0, 0.0}}, 0.0, 0.5);
  EXPECT_NEAR(found.bias, -0.55, 1e-12);
  EXPECT_NEAR(found.share_inside, 0.45, 1e-12);
}

TEST(MeasurementScore, IsOverWhatTheRunHasReached) {
  const MeasurementTable lab = measured(sampled([](double t) { return t < 1.5 ? 0.0 : 9.0; }, 3.0, 300), 0.1, 0.0);
  const MeasurementScore found = score(lab, sampled([](double) { return 0.0; }, 1.0, 10));
  EXPECT_NEAR(found.to, 0.9, 1e-9);  // later samples cannot be compared with every shift
  EXPECT_EQ(found.as_timed.rms, 0.0);
  EXPECT_EQ(score(lab, sampled([](double) { return 0.0; }, 0.05, 10)).samples, 0u);
  EXPECT_EQ(score(lab, Curve{}).samples, 0u);
}

/// A depth of x + t, taken at 1 and 2 s from 0 to 2 m; measured a tenth of a second early, and 0.01 m too low.
TEST(MeasurementScore, OfProfilesIsAtTheirTimesAndPlaces) {
  const ProbeProfiles computed{{1.0, 2.0}, {{0.0, 2.0}, {0.0, 2.0}}, {{1.0, 3.0}, {2.0, 4.0}}};
  MeasurementTable table;
  table.series = {"surface.csv", {2, 3, 4}, {1.0, 1.0, 1.5}, {{1.59, 3.09, 2.59}, {0.5, 2.0, 1.0}}};
  const MeasurementScore found = score(table, computed);
  EXPECT_EQ(found.samples, 3u);
  EXPECT_NEAR(found.as_timed.bias, -0.09, 1e-12);
  EXPECT_NEAR(found.as_timed.rms, 0.09, 1e-12);
  table.shift = 0.2;
  EXPECT_NEAR(score(table, computed).best_shift, 0.09, 0.0011);
  EXPECT_EQ(score(table, ProbeProfiles{}).samples, 0u);
}

TEST(MeasurementScores, AreReadFromTheTablesOfProbes) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "gauge.csv") << "t [ms], H1 [mm], H2 [mm]\n0, 7, 100\n500, 7, 110\n1000, 7, 120\n";
  const std::string keys =
      "particles.spacing = 0.1\ntime.end = 1.0\n[[fluid]]\nmin = [0, 0]\nmax = [1, 1]\n"
      "[[probe]]\nname = \"H2\"\ntype = \"depth\"\nat = [0, 0]\n[[measurement]]\nprobe = \"H2\"\ncolumn = \"wet\"\n"
      "scatter = 0.02\nfile = \"" +
      (folder.path() / "gauge.csv").string() + "\"\n" +
      "[[probe]]\nname = \"line\"\ntype = \"profile\"\nfrom = [0, 0]\nto = [1, 0]\ntimes = [0.5]\n" +
      "[[measurement]]\nprobe = \"line\"\nfile = \"" + (folder.path() / "line.csv").string() + "\"\n";
  std::ofstream(folder.path() / "line.csv") << "t [s], x [m], connected [m]\n0.5, 0.25, 0.3\n0.5, 0.75, 0.3\n";
  const CaseSpec spec = read_case_text(keys, "case.toml");
  const RunFolder run = RunFolder::create(folder.path() / "run", false);
  std::ofstream(run.probe("H2")) << "time_s,connected_m,highest_m,wet_m\n0,9,9,0.09\n0.5,9,9,nan\n1,9,9,0.11\n";
  std::ofstream(run.probe("line")) << "time_s,x_m,bed_m,connected_m,highest_m\n"
                                      "0.5001,0.25,0,0.3,9\n0.5001,0.5,0,0.4,9\n0.5001,0.75,0,0.5,9\n";
  const std::vector<MeasurementScore> scores = measurement_scores(spec, run.path());
  ASSERT_EQ(scores.size(), 2u);
  EXPECT_EQ(scores[0].unit, "m");
  EXPECT_EQ(scores[1].unit, "m");
  EXPECT_NEAR(scores[1].as_timed.bias, 0.1, 1e-12);
  EXPECT_NEAR(scores[1].as_timed.rms, std::sqrt(0.02), 1e-12);
  EXPECT_NEAR(scores[0].as_timed.bias, -0.01, 1e-12);
  const Json json = json_of(scores);
  EXPECT_EQ(json[0]["is_inside"], true);
  EXPECT_EQ(json[0]["samples"], 3);
  EXPECT_NE(json[0]["words"].get<std::string>().find("inside the scatter of 0.02 m"), std::string::npos) << json;
}

}  // namespace
}  // namespace tailwater
