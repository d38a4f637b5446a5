// The declarations of what probes write.
#include "case/probe_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <sstream>

#include "case_files/series_file.h"

namespace tailwater {
namespace {

std::vector<ProbeType> all_types() {
  std::vector<ProbeType> types;
  for (std::size_t k = 0; k < choices<ProbeType>.size(); ++k) types.push_back(static_cast<ProbeType>(k));
  return types;
}

/// All columns, also those that most probes do not write.
std::vector<OutputColumn> all_columns_of(ProbeType type, int dimension) {
  ProbeTable probe;
  probe.type = type;
  probe.diameter = 0.1;
  probe.moment_about = Coordinates(static_cast<std::size_t>(dimension), 0.0);
  return columns_of(probe, dimension, true);
}

std::vector<std::string> names_in(const std::vector<OutputColumn>& columns) {
  std::vector<std::string> names;
  for (const OutputColumn& column : columns) names.push_back(column.name);
  return names;
}

TEST(ProbeColumns, AreDeclaredForEachTypeWithNamesOfTheirOwn) {
  for (const ProbeType type : all_types()) {
    EXPECT_EQ(info_of(type).type, type);
    for (const int dimension : {2, 3}) {
      for (const auto& columns : {all_columns_of(type, dimension), totals_of(type, dimension)}) {
        const std::vector<std::string> names = names_in(columns);
        EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size()) << name_of(type);
      }
      EXPECT_FALSE(all_columns_of(type, dimension).empty()) << name_of(type);
    }
  }
}

TEST(ProbeColumns, ResultsNameColumnsThatExist) {
  for (const ProbeType type : all_types()) {
    std::vector<std::string> names = names_in(all_columns_of(type, 2));
    std::ranges::copy(names_in(all_columns_of(type, 3)), std::back_inserter(names));
    EXPECT_FALSE(info_of(type).results.empty()) << name_of(type);
    for (const DeclaredResult& result : info_of(type).results) {
      EXPECT_NE(std::ranges::find(names, result.column), names.end()) << name_of(type) << ' ' << result.column;
    }
  }
}

TEST(ProbeColumns, HaveTheUnitsOfTheirDimension) {
  const auto headings = [](const ProbeTable& probe, int dimension) {
    std::string text;
    for (const OutputColumn& column : columns_of(probe, dimension)) text += column.heading + ' ';
    return text;
  };
  ProbeTable force;
  force.type = ProbeType::force;
  EXPECT_EQ(headings(force, 2),
            "force_x_N_per_m force_y_N_per_m pressure_x_N_per_m pressure_y_N_per_m friction_x_N_per_m "
            "friction_y_N_per_m ");
  force.moment_about = {0.0, 0.0, 0.0};
  EXPECT_EQ(headings(force, 3),
            "force_x_N force_y_N force_z_N pressure_x_N pressure_y_N pressure_z_N friction_x_N friction_y_N "
            "friction_z_N moment_x_N_m moment_y_N_m moment_z_N_m ");
  ProbeTable motion;
  motion.type = ProbeType::motion;
  EXPECT_EQ(headings(motion, 2),
            "displacement_x_m displacement_y_m angle_rad velocity_x_m_per_s velocity_y_m_per_s "
            "angular_velocity_rad_per_s ");
  EXPECT_EQ(unit_of(Measure::energy, 2), "J per m");
  EXPECT_EQ(unit_of(Measure::energy, 3), "J");
}

/// The unit of a column in the summary and that of a laboratory's file have one meaning.
TEST(ProbeColumns, AreComparedInTheirOwnUnit) {
  for (const ProbeType type : all_types()) {
    for (const int dimension : {2, 3}) {
      ProbeTable probe;
      probe.type = type;
      probe.moment_about = Coordinates(static_cast<std::size_t>(dimension), 0.0);
      for (const OutputColumn& column : comparable_columns(probe, dimension)) {
        std::istringstream file("t [s], value [" + std::string(unit_of(column.measure, 3)) + "]\n0, 1.25\n1, 2.5\n");
        const std::array<std::string_view, 1> names{column.name};
        const TimeSeries series = parse_measured_series("lab.csv", file, names, column.measure, Samples::of_one_place);
        EXPECT_EQ(series.columns.at(0), (std::vector<double>{1.25, 2.5})) << name_of(type) << ' ' << column.name;
      }
    }
  }
}

TEST(ProbeColumns, ThatAreComparedByDefaultComeFirst) {
  ProbeTable probe;
  const auto first = [&](ProbeType type) {
    probe.type = type;
    return comparable_columns(probe, 2).at(0).name;
  };
  EXPECT_EQ(first(ProbeType::front), "front_connected");
  EXPECT_EQ(first(ProbeType::energy), "total");
  EXPECT_EQ(first(ProbeType::level_map), "mean");
  EXPECT_EQ(first(ProbeType::volume), "volume_out");
  probe.type = ProbeType::profile;
  EXPECT_TRUE(comparable_columns(probe, 3).empty());
  probe.type = ProbeType::velocity_profile;
  EXPECT_TRUE(comparable_columns(probe, 2).empty());
}

}  // namespace
}  // namespace tailwater
