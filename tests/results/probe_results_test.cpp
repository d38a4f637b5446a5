// Summaries of the tables of probes at the end of a run.
#include "results/probe_results.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "case/reader.h"
#include "io/temporary_folder.h"
#include "results/probe_table.h"

namespace tailwater {
namespace {

TEST(ProbeTable, MeansAreOverTimeAndLinearBetweenReadings) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  // From t = 2 on: 1 for 1 s, then a line up to 3 at t = 4, whose mean is 2. The reading of 5 at t = 1 precedes the
  // second half.
  std::ofstream(path) << "time_s,a_m,volume_m3\n0,9,0\n1,5,1\n2,1,2\n3,1,4\n4,3,8\n";
  const TableDigest table = digest_probe_table(path, 2.0);
  ASSERT_EQ(table.names, (std::vector<std::string>{"a_m", "volume_m3"}));
  EXPECT_DOUBLE_EQ(table.columns[0].mean_of_second_half().value(), 0.5 * (1.0 + 2.0));
  EXPECT_DOUBLE_EQ(table.columns[1].rate_in_second_half().value(), 3.0);
  EXPECT_EQ(table.columns[0].least, 1.0);
  EXPECT_EQ(table.columns[0].largest, 9.0);
  EXPECT_EQ(table.columns[0].time_of_largest, 0.0);
  // If the second half begins between two readings, its first value is interpolated: 3 at t = 1.5.
  EXPECT_DOUBLE_EQ(digest_probe_table(path, 1.5).columns[0].mean_of_second_half().value(),
                   (0.5 * 2.0 + 1.0 + 2.0) / 2.5);
}

TEST(ProbeTable, AMeanThatStillChangesIsToldApart) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  // Rises by 2 % from t = 4 to t = 8, by 0.9 %, falls, goes up and down, and has readings from t = 6 on alone.
  std::ofstream(path) << "time_s,a,b,c,d,e\n0,0,0,0,0,nan\n4,1,1,9,1,nan\n5,1.005,1.00225,8,3,nan\n"
                         "6,1.01,1.0045,7,1,1\n7,1.015,1.00675,6,2,2\n8,1.02,1.009,5,2.5,3\n";
  const TableDigest table = digest_probe_table(path, 4.0);
  const auto trend = [&](std::size_t k) { return table.columns[k].trend_of_mean(); };
  EXPECT_EQ((std::array{trend(0), trend(1), trend(2), trend(3), trend(4)}), (std::array{1, 0, -1, 0, 0}));
  EXPECT_NEAR(table.columns[0].mean_of_second_half().value(), 1.01, 1e-12);
  EXPECT_NEAR(table.columns[4].mean_of_second_half().value(), 2.0, 1e-12);
}

TEST(ProbeTable, ARateThatStillChangesIsToldApart) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  // A volume that passes at 1 and, from t = 4 on, at a rate that rises by 3 %, that stays, and that falls.
  std::ofstream(path) << "time_s,a,b,c\n0,0,0,0\n4,4,4,4\n5,5,5,4.8\n6,6.01,6,5.5\n7,7.03,7,6.1\n8,8.06,8,6.6\n";
  const TableDigest table = digest_probe_table(path, 4.0);
  const auto trend = [&](std::size_t k) { return table.columns[k].trend_of_rate(); };
  EXPECT_EQ((std::array{trend(0), trend(1), trend(2)}), (std::array{1, 0, -1}));
  EXPECT_NEAR(table.columns[0].rate_in_second_half().value(), 4.06 / 4.0, 1e-12);
}

TEST(ProbeTable, LargestMeansAreOverTheTimeGiven) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  // A spike of 5000 for 0.01 s, then 2000 until the end.
  std::ofstream(path) << "time_s,impulse_Pa_s\n0,0\n0.1,0\n0.11,50\n0.15,130\n0.2,230\n";
  const auto largest = [&](double over) { return digest_probe_table(path, 0.0, over).columns[0].largest_rate; };
  EXPECT_NEAR(largest(0.0).value(), 5000.0, 1e-8);
  EXPECT_NEAR(largest(0.0).time(), 0.11, 1e-12);
  // Over 0.05 s: 1000 at the end of the spike, 130/0.05 at 0.15 s, which has all of it, and 2000 at the end.
  EXPECT_NEAR(largest(0.05).value(), 2600.0, 1e-8);
  EXPECT_NEAR(largest(0.05).time(), 0.15, 1e-12);
  EXPECT_NEAR(largest(0.1).value(), 2300.0, 1e-8);
  // Between two lines there is no shorter mean.
  EXPECT_NEAR(largest(0.001).over(), 0.01, 1e-12);
  EXPECT_NEAR(largest(0.05).over(), 0.05, 1e-12);
  EXPECT_NEAR(largest(1.0).value(), 230.0 / 0.2, 1e-8);  // longer than the table
  // A rate of its own, linear between lines: 1 from 1 s to 2 s.
  std::ofstream(path) << "time_s,pressure_Pa\n0,0\n1,1\n2,1\n3,0\n";
  EXPECT_NEAR(digest_probe_table(path, 0.0, 1.0).columns[0].largest_mean.value(), 1.0, 1e-12);
  EXPECT_NEAR(digest_probe_table(path, 0.0, 2.0).columns[0].largest_mean.value(), 0.75, 1e-12);
}

TEST(ProbeTable, OneReadingAndNumbersThatAreNone) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  std::ofstream(path) << "time_s,a_m,b_m\n0,2,nan\n";
  const TableDigest table = digest_probe_table(path, 0.0);
  EXPECT_EQ(table.columns[0].mean_of_second_half(), 2.0);
  EXPECT_EQ(table.columns[1].count, 0u);
  EXPECT_THROW(digest_probe_table(folder.path() / "no.csv", 0.0), IoError);
}

TEST(ProbeTable, AMeanIsOfReadingsInTheSecondHalf) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  std::ofstream(path) << "time_s,a_m,volume_m3\n0,0,0\n0.6,5,3\n";
  const ColumnDigest one = digest_probe_table(path, 0.5).columns[0];
  EXPECT_EQ(one.readings_in_second_half(), 1);
  EXPECT_EQ(one.mean_of_second_half(), 5.0);  // the line from the start to it is no reading
  EXPECT_EQ(one.trend_of_mean(), 0);
  EXPECT_FALSE(digest_probe_table(path, 0.5).columns[1].rate_in_second_half().has_value());
  const ColumnDigest none = digest_probe_table(path, 0.7).columns[0];
  EXPECT_EQ(none.readings_in_second_half(), 0);
  EXPECT_FALSE(none.mean_of_second_half().has_value());
}

TEST(ProbeTable, HasTheMagnitudeOfAForceAndTheLinesOfTheLastTime) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "probe.csv";
  std::ofstream(path) << "time_s,force_x_N_per_m,force_y_N_per_m\n0,1,0\n1,3,4\n1,0,-2\n";
  const TableDigest table = digest_probe_table(path, 0.5);
  EXPECT_DOUBLE_EQ(table.magnitude_of_force.largest, 5.0);
  EXPECT_EQ(table.magnitude_of_moment.count, 0);
  EXPECT_EQ(table.columns[1].min_of_last, -2.0);
  EXPECT_EQ(table.columns[1].largest_of_last, 4.0);
}

/// The summary of a probe of the given type whose table has this text.
class Results : public testing::Test {
 protected:
  std::string words(const std::string& type_and_keys, const std::string& table, double time, int dimension = 2) const {
    const std::string zeros = dimension == 2 ? "[0, 0]" : "[0, 0, 0]", ones = dimension == 2 ? "[1, 1]" : "[1, 1, 1]";
    const CaseSpec spec =
        read_case_text("case.dimension = " + std::to_string(dimension) +
                           "\nparticles.spacing = 0.1\ntime.end = 1\n[[fluid]]\nmin = " + zeros + "\nmax = " + ones +
                           "\n[[probe]]\nname = \"p\"\ntype = " + type_and_keys + "\n",
                       "case.toml");
    const TemporaryFolder home;
    const RunFolder folder = RunFolder::create(home.path() / "run", false);
    std::ofstream(folder.probe("p")) << table;
    const std::vector<ProbeResult> results = probe_results(spec, folder, time);
    if (results.empty()) return "";
    EXPECT_EQ(json_of(results)["p"]["words"], results[0].words());
    EXPECT_EQ(json_of(results)["p"]["quantities"].size(), results[0].quantities.size());
    return results[0].words();
  }
};

TEST_F(Results, AreToldInWords) {
  EXPECT_EQ(words("\"depth\"\nat = [0, 0]",
                  "time_s,connected_m,highest_m,wet_m\n0,0.2,0.3,0.2\n1,0.289,0.289,0.2\n1.2,0.289,0.29,0.2\n"
                  "1.4,0.289,0.29,0.2\n1.6,0.289,0.29,0.2\n2,0.289,0.29,0.2\n",
                  2.0),
            "0.2890 m (mean of the second half), highest 0.3000 m (at 0 s)");
  EXPECT_EQ(words("\"depth\"\nat = [0, 0]",
                  "time_s,connected_m,highest_m,wet_m\n0,0.2,0.3,0.2\n4,0.24,0.24,0.2\n8,0.28,0.28,0.2\n", 8.0),
            "0.2600 m (mean of 2 readings in the second half, still rising), highest 0.3000 m (at 0 s)");
  EXPECT_EQ(
      words("\"force\"\nmoment_about = [0, 0]",
            "time_s,force_x_N_per_m,force_y_N_per_m,pressure_x_N_per_m\n0,0,0,0\n1,380,-12,0\n2,380,-12,0\n", 2.0),
      "x 380.0 N/m, y -12.0 N/m (mean of 2 readings in the second half), largest 380.2 N/m (at 1 s)");
  EXPECT_EQ(
      words("\"force\"\nmoment_about = [0, 0]",
            "time_s,force_x_N_per_m,force_y_N_per_m,moment_N_m_per_m\n0,3,4,0\n1,3,4,-8\n2,3,4,6\n", 2.0),
      "x 3.000 N/m, y 4.000 N/m (mean of 2 readings in the second half), largest 5.000 N/m (at 0 s), moment -1.000 "
      "N m/m (mean of 2 readings in the second half, still rising), largest moment 8.000 N m/m (at 1 s)");
  EXPECT_EQ(
      words("\"force\"\nmoment_about = [0, 0, 0]",
            "time_s,force_x_N,moment_x_N_m,moment_y_N_m,moment_z_N_m\n0,1,3,4,0\n1,1,0.001,1,2\n", 1.0, 3),
      "x 1.000 N (only reading in the second half), largest 1.000 N (at 0 s), moment x 0 N m, moment y 1.000 N m, "
      "moment z 2.000 N m (only reading in the second half), largest moment 5.000 N m (at 0 s)");
  // Below a thousandth of the vector a component is rounding and noise.
  EXPECT_EQ(words("\"force\"\nmoment_about = [0, 0]",
                  "time_s,force_x_N_per_m,force_y_N_per_m,pressure_x_N_per_m\n0,0.3,380,0\n2,0.3,380,0\n", 2.0),
            "x 0 N/m, y 380.0 N/m (only reading in the second half), largest 380.0 N/m (at 0 s)");
  EXPECT_EQ(words("\"discharge\"\nfrom = [0, 0]\nto = [0, 1]",
                  "time_s,discharge_m3_per_s,volume_m3\n0,0,0\n1,0.06,0.01\n2,0.04,0.06\n", 2.0),
            "0.05000 m^3/s per m (mean of 2 readings in the second half), largest 0.06000 m^3/s per m (at 1 s, "
            "mean over 1 s)");
  // Each discharge is a mean over 0.64 s. In the first 0.64 s it is a mean over less, so 0.09 is not the largest.
  const std::string section = "\"discharge\"\nfrom = [0, 0]\nto = [0, 1]";
  const std::string discharges =
      "time_s,discharge_m3_per_s,volume_m3\n0,0,0\n0.6,0.09,0.01\n0.7,0.06,0.02\n1,0.05,0.03\n1.2,0.05,0.04\n";
  EXPECT_EQ(words(section, discharges + "1.8,0.05,0.07\n2,0.05,0.08\n", 2.0),
            "0.05000 m^3/s per m (mean of 4 readings in the second half), largest 0.06000 m^3/s per m (at 0.7 s, mean "
            "over 0.64 s)");
  EXPECT_EQ(words(section, discharges, 1.2), "0.05000 m^3/s per m (mean of 4 readings in the second half)")
      << "the second half is shorter than 0.64 s";
  EXPECT_EQ(words(section, discharges + "1.8,0.05,0.08\n2,0.05,0.12\n", 2.0),
            "0.09000 m^3/s per m, largest 0.09000 m^3/s per m (mean of 4 readings in the second half, still rising)");
  // From the impulse alone: the pressures at the times of the lines have no effect. Without a time for means they are
  // those between two lines.
  EXPECT_EQ(
      words("\"wall-pressure\"\nat = [0, 0, 0]",
            "time_s,pressure_Pa,impulse_Pa_s\n0,0,0\n1,0,0\n1.5,99,50\n2,9000,6050\n3,7000,7050\n4,900,7950\n", 4.0, 3),
      "950.0 Pa (mean of 3 readings in the second half, still falling), largest 12000 Pa (at 2 s, mean over 0.5 s), "
      "rise time "
      "0.5000 s (from a tenth to the largest), impulse 7950 Pa s (at 4 s)");
  EXPECT_EQ(
      words("\"wall-pressure\"\nat = [0, 0, 0]", "time_s,pressure_Pa,impulse_Pa_s\n0,0,0\n1,12,12\n2,9,21\n", 2.0, 3),
      "9.000 Pa (mean of 2 readings in the second half), largest 12.00 Pa (at 1 s, mean over 1 s), impulse 21.00 Pa s "
      "(at 2 s)");
  EXPECT_EQ(words("\"depth\"\nat = [0, 0]", "time_s,connected_m,highest_m,wet_m\n", 2.0), "");
}

// The probe's interval is longer than the run.
TEST_F(Results, WithoutTheirReadingsAreAbsent) {
  EXPECT_EQ(words("\"depth\"\nat = [0, 0]", "time_s,connected_m,highest_m,wet_m\n0,0.2,0.3,0.2\n", 2.0),
            "highest 0.3000 m (at 0 s)");
  EXPECT_EQ(words("\"pressure\"\nat = [0, 0]", "time_s,pressure_Pa,wet\n0,900,1\n", 2.0), "");
  EXPECT_EQ(words("\"wall-pressure\"\nat = [0, 0]", "time_s,pressure_Pa,impulse_Pa_s\n0,0,0\n", 2.0),
            "impulse 0 Pa s (at 0 s)");
  EXPECT_EQ(words("\"wall-pressure\"\nat = [0, 0]", "time_s,pressure_Pa,impulse_Pa_s\n0,0,0\n1.2,50,60\n", 2.0),
            "largest 50.00 Pa (at 1.2 s, mean over 1.2 s), impulse 60.00 Pa s (at 1.2 s)");
}

}  // namespace
}  // namespace tailwater
