// Quantities over time, from a CSV file that the case names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

/// What a column measures; it decides which units the header may name.
enum class Measure { length, angle, speed, discharge, volume, pressure, force, moment, energy };

struct SeriesColumn {
  std::string_view name;
  Measure measure = Measure::length;
};

struct TimeSeries {
  std::string file;                          ///< for messages
  std::vector<int> line;                     ///< of the file, by sample
  std::vector<double> time;                  ///< s, ascending
  std::vector<std::vector<double>> columns;  ///< by column that was asked for, in SI units; empty if it is not there

  bool empty() const { return time.empty(); }
  bool operator==(const TimeSeries&) const = default;
};

}  // namespace tailwater
