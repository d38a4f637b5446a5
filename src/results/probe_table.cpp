#include "results/probe_table.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string_view>

#include "base/input_file.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

/// Calls take(k, field) for the fields of a line.
template <class Take>
void for_each_cell(std::string_view line, const Take& take) {
  for (std::size_t k = 0, begin = 0; begin <= line.size(); ++k) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    take(k, line.substr(begin, end - begin));
    begin = end + 1;
  }
}

double parsed_number(std::string_view field) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(field.data(), field.data() + field.size(), value);
  return value;
}

/// Calls take(time, second, value) for the lines of a table that have a time and a number in the column with this
/// heading; `second` is the number in the second column.
template <class Take>
void read_column(const std::filesystem::path& path, std::string_view heading, const Take& take) {
  std::ifstream file = open_input_file(path);
  if (!file) throw_io_error("read", path, errno);
  std::string line;
  std::getline(file, line);
  std::size_t place = 0;
  for_each_cell(line, [&](std::size_t k, std::string_view name) {
    if (name == heading) place = k;
  });
  while (place > 0 && std::getline(file, line)) {
    double time = std::numeric_limits<double>::quiet_NaN();
    double second = time;
    double value = time;
    for_each_cell(line, [&](std::size_t k, std::string_view field) {
      if (k == 0) time = parsed_number(field);
      if (k == 1) second = parsed_number(field);
      if (k == place) value = parsed_number(field);
    });
    if (!std::isnan(time) && !std::isnan(value)) take(time, second, value);
  }
}

}  // namespace

void LargestMean::add(double time, double sum, double over) {
  constexpr double low = 0.1;
  constexpr double rounding = 1e-9;
  lines_.push_back({time, sum});
  const double begin = std::min(time - over, lines_.size() > 1 ? lines_[lines_.size() - 2].time : time);
  if (begin < lines_.front().time - rounding * over || lines_.size() == 1) return;
  while (lines_[1].time <= begin) lines_.pop_front();
  const double mean = (sum - sum_at(begin)) / (time - begin);
  while (!means_.empty() && means_.back().value >= mean) means_.pop_back();
  if (!is_whole_ || mean > value_) {
    value_ = mean;
    time_ = time;
    over_ = time - begin;
    const auto above = std::ranges::partition_point(means_, [&](const Line& one) { return one.value < low * mean; });
    rise_ = above == means_.begin() ? 0.0 : time - std::prev(above)->time;
  }
  is_whole_ = true;
  means_.push_back({time, mean});
}

double LargestMean::sum_at(double time) const {
  const Line &before = lines_[0], &after = lines_[1];
  const double share = std::clamp((time - before.time) / (after.time - before.time), 0.0, 1.0);
  return before.value + share * (after.value - before.value);
}

double LargestMean::value() const {
  if (is_whole_ || lines_.size() < 2) return value_;
  return (lines_.back().value - lines_.front().value) / (lines_.back().time - lines_.front().time);
}

void ColumnDigest::add(double time, double value, double half, double over) {
  constexpr double rounding = 1e-9;
  const bool is_first = count++ == 0;
  if (is_first) first_time_ = time;
  if (is_first || value < least) least = value;
  if (is_first || value > largest) {
    largest = value;
    time_of_largest = time;
  }
  const bool is_same_time = !is_first && time == last_time;
  if (is_first || time > last_time) {
    if (time >= half) ++readings_in_second_half_;
    const bool is_mean = !is_first && std::min(time - first_time_, half) >= (1.0 - rounding) * over;
    if (is_mean && (!largest_moving_mean || value > largest_moving_mean->value)) {
      largest_moving_mean = {value, time, std::max(over, time - last_time)};
    }
    if (!is_first) sum_ += 0.5 * (last + value) * (time - last_time);
    largest_rate.add(time, value, over);
    largest_mean.add(time, sum_, over);
  }
  min_of_last = is_same_time ? std::min(min_of_last, value) : value;
  largest_of_last = is_same_time ? std::max(largest_of_last, value) : value;
  if (!is_first) add_stretch(time, value, half);
  last = value;
  last_time = time;
}

/// Adds the time since the last reading to the quarters of the second half; the run ends at twice `half`.
void ColumnDigest::add_stretch(double time, double value, double half) {
  const double slope = time > last_time ? (value - last) / (time - last_time) : 0.0;
  for (std::size_t k = 0; k < quarters_.size(); ++k) {
    const double from = std::max(last_time, half * (1.0 + 0.25 * static_cast<double>(k)));
    const double to =
        k + 1 == quarters_.size() ? time : std::min(time, half * (1.0 + 0.25 * static_cast<double>(k + 1)));
    if (to <= from) continue;
    quarters_[k].length += to - from;
    quarters_[k].integral += (last + slope * (0.5 * (from + to) - last_time)) * (to - from);
    quarters_[k].growth += slope * (to - from);
  }
}

/// The sum of `part` over the second half, per second. The second half has at least two readings.
double ColumnDigest::per_second(double Quarter::*part) const {
  double length = 0.0;
  double sum = 0.0;
  for (const Quarter& quarter : quarters_) {
    length += quarter.length;
    sum += quarter.*part;
  }
  return sum / length;
}

int ColumnDigest::trend(double Quarter::*part) const {
  constexpr double min_change = 0.01;
  if (readings_in_second_half_ < 2) return 0;
  if (std::ranges::any_of(quarters_, [](const Quarter& quarter) { return quarter.length == 0.0; })) return 0;
  std::array<double, 4> means{};
  std::ranges::transform(quarters_, means.begin(), [&](const Quarter& one) { return one.*part / one.length; });
  const double size = std::max(std::abs(means.front()), std::abs(means.back()));
  if (std::abs(means.back() - means.front()) <= min_change * size) return 0;
  if (std::ranges::is_sorted(means)) return 1;
  return std::ranges::is_sorted(means, std::greater<>()) ? -1 : 0;
}

std::optional<double> ColumnDigest::mean_of_second_half() const {
  if (readings_in_second_half_ == 0) return {};
  return readings_in_second_half_ == 1 ? last : per_second(&Quarter::integral);
}

std::optional<double> ColumnDigest::rate_in_second_half() const {
  if (readings_in_second_half_ < 2) return {};
  return per_second(&Quarter::growth);
}

int ColumnDigest::trend_of_mean() const { return trend(&Quarter::integral); }
int ColumnDigest::trend_of_rate() const { return trend(&Quarter::growth); }

ProbeColumn read_probe_column(const std::filesystem::path& path, std::string_view heading) {
  ProbeColumn column;
  read_column(path, heading, [&](double time, double, double value) {
    if (!column.time.empty() && time <= column.time.back()) {
      column.time.pop_back();
      column.value.pop_back();
    }
    column.time.push_back(time);
    column.value.push_back(value);
  });
  return column;
}

ProbeProfiles read_probe_profiles(const std::filesystem::path& path, std::string_view heading) {
  ProbeProfiles profiles;
  read_column(path, heading, [&](double time, double x, double value) {
    if (profiles.time.empty() || time > profiles.time.back()) {
      profiles.time.push_back(time);
      profiles.x.emplace_back();
      profiles.value.emplace_back();
    }
    profiles.x.back().push_back(x);
    profiles.value.back().push_back(value);
  });
  return profiles;
}

TableDigest digest_probe_table(const std::filesystem::path& path, double half, double over) {
  std::ifstream file = open_input_file(path);
  if (!file) throw_io_error("read", path, errno);
  TableDigest table;
  std::string line;
  std::getline(file, line);
  struct Vector {
    std::string_view begin_of_names;
    ColumnDigest& magnitude;
    std::vector<std::size_t> components = {};
  };
  std::array vectors{Vector{"force_", table.magnitude_of_force}, Vector{"moment_", table.magnitude_of_moment}};
  for_each_cell(line, [&](std::size_t k, std::string_view name) {
    if (k == 0) return;
    for (Vector& vector : vectors) {
      if (name.starts_with(vector.begin_of_names)) vector.components.push_back(k - 1);
    }
    table.names.emplace_back(name);
  });
  table.columns.resize(table.names.size());
  std::vector<double> row(table.names.size());
  while (std::getline(file, line)) {
    std::ranges::fill(row, std::numeric_limits<double>::quiet_NaN());
    double time = 0.0;
    for_each_cell(line, [&](std::size_t k, std::string_view field) {
      if (k == 0) time = parsed_number(field);
      if (k > 0 && k <= row.size()) row[k - 1] = parsed_number(field);
    });
    if (std::isnan(time)) continue;
    table.last_time = time;
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (!std::isnan(row[k])) table.columns[k].add(time, row[k], half, over);
    }
    for (const Vector& vector : vectors) {
      if (vector.components.empty()) continue;
      double squares = 0.0;
      for (const std::size_t k : vector.components) squares += row[k] * row[k];
      if (!std::isnan(squares)) vector.magnitude.add(time, std::sqrt(squares), half, over);
    }
  }
  return table;
}

}  // namespace tailwater
