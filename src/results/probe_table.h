// A digest of the table that a probe has written: a few numbers per column. The table is read once from the begin to
// the end, with little memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

struct ColumnDigest {
  std::size_t count = 0;  ///< number of values; "nan" is none
  double least = 0.0;
  double largest = 0.0;
  double time_of_largest = 0.0;  ///< s
  double last = 0.0;
  double last_time = 0.0;             ///< s
  double least_of_last = 0.0;         ///< smallest value in the lines of the last time
  double largest_of_last = 0.0;       ///< largest value in the lines of the last time
  double largest_rate = 0.0;          ///< largest growth per second from a line to the next
  double time_of_largest_rate = 0.0;  ///< s; time of the later of the two lines
  double rise = 0.0;  ///< s; from the last line below a tenth of the largest to the largest; 0: there is none

  void add(double time, double value, double half);

  /// Mean over time, linear between readings; the last reading if there is only one.
  double mean_of_second_half() const;
  /// Growth per second.
  double rate_in_second_half() const;

 private:
  void add_rate(double time, double rate);

  struct Rate {
    double time;
    double value;
  };
  std::vector<Rate> rates_;  ///< ascending: each is the last with a value so small
  bool has_begun_half_ = false;
  double half_begin_ = 0.0;  ///< s
  double value_at_half_ = 0.0;
  double integral_ = 0.0;
};

struct TableDigest {
  std::vector<std::string> names;  ///< without the name of the time
  std::vector<ColumnDigest> columns;
  ColumnDigest magnitude_of_force;  ///< empty in a table without a force
  double last_time = 0.0;           ///< s
};

struct ProbeColumn {
  std::vector<double> time;  ///< s, ascending
  std::vector<double> value;
};

/// The column with this heading; empty if there is none. Lines without a number are left out, and so are all but the
/// last line of one time. Throws IoError if the file cannot be read.
ProbeColumn read_probe_column(const std::filesystem::path& path, std::string_view heading);

/// A column of a table that has several lines per time, one for each place.
struct ProbeProfiles {
  std::vector<double> time;            ///< s, ascending
  std::vector<std::vector<double>> x;  ///< m; the places at each time, ascending
  std::vector<std::vector<double>> value;
};

/// See read_probe_column; the places are in the table's second column.
ProbeProfiles read_probe_profiles(const std::filesystem::path& path, std::string_view heading);

/// The second half begins at `half` [s]. Throws IoError if the file cannot be read.
TableDigest digest_probe_table(const std::filesystem::path& path, double half);

}  // namespace tailwater
