// Quantities over time, from a CSV file that the case names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

/// The quantity of a column, which decides its unit. No file may have one of the last five.
enum class Measure {
  length,
  angle,
  speed,
  discharge,
  volume,
  pressure,
  force,
  moment,
  energy,
  number,
  time,
  angular_speed,
  impulse,
  power,
  shear_rate,
};

struct SeriesColumn {
  std::string_view name;
  Measure measure = Measure::length;
};

struct TimeSeries {
  std::string file;                          ///< for messages
  std::vector<int> line;                     ///< line of the file, by sample
  std::vector<double> time;                  ///< s, ascending
  std::vector<std::vector<double>> columns;  ///< by requested column, in SI units; empty if it is absent

  bool empty() const { return time.empty(); }
  bool operator==(const TimeSeries&) const = default;
};

}  // namespace tailwater
