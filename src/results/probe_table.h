// The table that a probe has written, in a few numbers per column. Read once from the begin to the end, in little
// memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

struct ColumnDigest {
  std::size_t count = 0;  ///< of numbers; "nan" is none
  double least = 0.0;
  double largest = 0.0;
  double time_of_largest = 0.0;  ///< s
  double last = 0.0;
  double last_time = 0.0;             ///< s
  double least_of_last = 0.0;         ///< among the lines of the last time
  double largest_of_last = 0.0;       ///< likewise
  double largest_rate = 0.0;          ///< by which it grows per second from a line to the next
  double time_of_largest_rate = 0.0;  ///< s; of the later one
  double rise = 0.0;  ///< s; from the last line at which it was below a tenth of that; 0: it was at none

  void add(double time, double value, double half);

  /// Over time, linear between readings; the last reading where there is only one.
  double mean_of_second_half() const;
  /// By which it has grown per second.
  double rate_in_second_half() const;

 private:
  void add_rate(double time, double rate);

  struct Rate {
    double time;
    double value;
  };
  std::vector<Rate> rates_;  ///< ascending: each the last that was so small
  bool has_begun_half_ = false;
  double half_begin_ = 0.0;  ///< s
  double value_at_half_ = 0.0;
  double integral_ = 0.0;
};

struct TableDigest {
  std::vector<std::string> names;  ///< without that of the time
  std::vector<ColumnDigest> columns;
  ColumnDigest magnitude_of_force;  ///< empty in a table without a force
  double last_time = 0.0;           ///< s
};

struct ProbeColumn {
  std::vector<double> time;  ///< s, ascending
  std::vector<double> value;
};

/// The column with this heading; empty if there is none. Lines without a number are left out, and all but the last of
/// one time. Throws IoError if the file cannot be read.
ProbeColumn read_probe_column(const std::filesystem::path& path, std::string_view heading);

/// A column of a table that has several lines of one time, each of a place.
struct ProbeProfiles {
  std::vector<double> time;            ///< s, ascending
  std::vector<std::vector<double>> x;  ///< m; of each time its places, ascending
  std::vector<std::vector<double>> value;
};

/// As read_probe_column; the places are in the table's second column.
ProbeProfiles read_probe_profiles(const std::filesystem::path& path, std::string_view heading);

/// `half` [s] is where the second half begins. Throws IoError if the file cannot be read.
TableDigest digest_probe_table(const std::filesystem::path& path, double half);

}  // namespace tailwater
