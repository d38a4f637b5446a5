// A digest of the table that a probe has written: a few numbers per column. The table is read once from the begin to
// the end, with little memory.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

/// The largest mean over a stretch of time of a rate, from its sum since the start, linear between lines.
class LargestMean {
 public:
  /// Adds the sum at a later time. Each mean is over a time of `over` [s], or between two lines that are farther apart.
  void add(double time, double sum, double over);

  /// Whether there are two lines, which a mean takes.
  bool is_known() const { return is_whole_ || lines_.size() > 1; }
  /// Over the whole table if that is shorter; 0 if it is not known.
  double value() const;
  double time() const { return time_; }  ///< s; end of the stretch
  /// s; length of the stretch: longer than that of `add` between lines that are farther apart
  double over() const { return over_; }
  /// s; from the last line at which the mean is below a tenth of the largest to the largest; 0: there is none
  double rise() const { return rise_; }

 private:
  struct Line {
    double time;
    double value;
  };
  double sum_at(double time) const;

  std::deque<Line> lines_;   ///< sums of the last stretch, and the line before it
  std::vector<Line> means_;  ///< ascending: each is the last with a value so small
  bool is_whole_ = false;    ///< whether a stretch was within the table
  double value_ = 0.0;
  double time_ = 0.0;
  double over_ = 0.0;
  double rise_ = 0.0;
};

struct ColumnDigest {
  std::size_t count = 0;  ///< number of values; "nan" is none
  double least = 0.0;
  double largest = 0.0;
  double time_of_largest = 0.0;  ///< s
  double last = 0.0;
  double last_time = 0.0;        ///< s
  double min_of_last = 0.0;      ///< smallest value in the lines of the last time
  double largest_of_last = 0.0;  ///< largest value in the lines of the last time
  LargestMean largest_rate;      ///< of the growth per second
  LargestMean largest_mean;
  struct MovingMean {
    double value;
    double time;  ///< s
    double over;  ///< s; longer than that of `add` between lines that are farther apart
  };
  /// The largest value, if each is a mean over the time before it. Values count from the time `over` after the first
  /// line on; nothing if the second half is shorter than `over`.
  std::optional<MovingMean> largest_moving_mean;

  /// The second half begins at `half` [s]; largest means are over a time of `over` [s].
  void add(double time, double value, double half, double over);

  /// Number of times with a reading in the second half.
  int readings_in_second_half() const { return readings_in_second_half_; }
  /// Mean over time, linear between readings; if there is one reading, its value. Nothing without a reading.
  std::optional<double> mean_of_second_half() const;
  /// Growth per second; nothing without two readings.
  std::optional<double> rate_in_second_half() const;
  /// 1 or -1: the mean of each quarter of the second half is larger, or smaller, than that of the quarter before, and
  /// the whole change is more than 1 % of them, so a steady state was not reached. 0: neither.
  int trend_of_mean() const;
  /// As trend_of_mean, of the growth per second.
  int trend_of_rate() const;

 private:
  struct Quarter {
    double length = 0.0;    ///< s; with readings
    double integral = 0.0;  ///< over time
    double growth = 0.0;
  };
  void add_stretch(double time, double value, double half);
  double per_second(double Quarter::*part) const;
  int trend(double Quarter::*part) const;

  int readings_in_second_half_ = 0;
  double first_time_ = 0.0;          ///< s
  double sum_ = 0.0;                 ///< integral since the first line
  std::array<Quarter, 4> quarters_;  ///< of the second half
};

struct TableDigest {
  std::vector<std::string> names;  ///< without the name of the time
  std::vector<ColumnDigest> columns;
  ColumnDigest magnitude_of_force;   ///< empty in a table without a force
  ColumnDigest magnitude_of_moment;  ///< empty in a table without a moment
  double last_time = 0.0;            ///< s
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

/// See ColumnDigest::add. Throws IoError if the file cannot be read.
TableDigest digest_probe_table(const std::filesystem::path& path, double half, double over = 0.0);

}  // namespace tailwater
