#include "case_files/series_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "case_files/column_file.h"

namespace tailwater {
namespace {

constexpr std::size_t max_samples = 1000000;

constexpr std::array<Unit, 4> time_units{{{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"h", 3600.0}}};
constexpr std::array<Unit, 2> angle_units{{{"rad", 1.0}, {"deg", std::numbers::pi / 180.0}}};
constexpr std::array<Unit, 3> speed_units{{{"m/s", 1.0}, {"cm/s", 1e-2}, {"mm/s", 1e-3}}};
// Quantities per metre of width in 2D may have the unit with or without "/m".
constexpr std::array<Unit, 9> discharge_units{{{"m^3/s", 1.0},
                                               {"m3/s", 1.0},
                                               {"m^3/s/m", 1.0},
                                               {"m^2/s", 1.0},
                                               {"m2/s", 1.0},
                                               {"l/s", 1e-3},
                                               {"l/s/m", 1e-3},
                                               {"m^3/h", 1.0 / 3600.0},
                                               {"m3/h", 1.0 / 3600.0}}};
constexpr std::array<Unit, 5> volume_units{{{"m^3", 1.0}, {"m3", 1.0}, {"l", 1e-3}, {"m^3/m", 1.0}, {"l/m", 1e-3}}};
constexpr std::array<Unit, 5> pressure_units{{{"pa", 1.0}, {"hpa", 1e2}, {"kpa", 1e3}, {"mbar", 1e2}, {"bar", 1e5}}};
constexpr std::array<Unit, 4> force_units{{{"n", 1.0}, {"kn", 1e3}, {"n/m", 1.0}, {"kn/m", 1e3}}};
constexpr std::array<Unit, 4> moment_units{{{"n m", 1.0}, {"kn m", 1e3}, {"n m/m", 1.0}, {"kn m/m", 1e3}}};
constexpr std::array<Unit, 4> energy_units{{{"j", 1.0}, {"kj", 1e3}, {"j/m", 1.0}, {"kj/m", 1e3}}};

// In the order of Measure.
constexpr std::array<std::span<const Unit>, 9> units_in_files{length_units,    angle_units,  speed_units,
                                                              discharge_units, volume_units, pressure_units,
                                                              force_units,     moment_units, energy_units};

class SeriesFile : ColumnFile {
 public:
  SeriesFile(const std::filesystem::path& path, std::span<const SeriesColumn> columns)
      : ColumnFile(path), wanted_(columns) {
    series_.file = path.string();
    series_.columns.resize(columns.size());
  }

  /// For a file of measured values, whose first requested column has one of `names`.
  SeriesFile(const std::filesystem::path& path, std::span<const SeriesColumn> columns,
             std::span<const std::string_view> names)
      : SeriesFile(path, columns) {
    names_ = names;
  }

  TimeSeries read(std::istream& file) {
    for_each_line(file, [this](std::string_view line) { take(line); });
    if (series_.time.size() < 2) {
      wrong(
          "the file has {} lines of numbers; give at least two, with a line before them that names the columns, as in "
          "\"{}\"",
          series_.time.size(), example());
    }
    return std::move(series_);
  }

 private:
  static constexpr std::size_t time_column = static_cast<std::size_t>(-1);
  static constexpr std::size_t no_column = static_cast<std::size_t>(-2);

  /// One column of the file: the index among the requested columns, and its unit.
  struct Found {
    std::size_t wanted;
    double unit;
  };

  /// The first is the SI unit.
  static std::span<const Unit> units_of(const SeriesColumn& column) {
    return units_in_files[static_cast<std::size_t>(column.measure)];
  }

  /// An example of a valid header.
  std::string example() const {
    std::string text = "t [s]";
    for (const SeriesColumn& column : wanted_)
      text += fmt::format(", {} [{}]", column.name, units_of(column).front().name);
    return text;
  }

  void take(std::string_view line) {
    if (separator_ == '\0') {
      separator_ = separator_of(line);
      const std::vector<std::string_view> fields = fields_of(line, separator_);
      width_ = fields.size();
      take_header(fields);
      return;
    }
    const std::vector<std::string_view> fields = numbers_of(line);
    if (series_.time.size() == max_samples) {
      wrong("has more than {} lines of numbers; give fewer", max_samples);
    }
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const auto [wanted, unit] = found_[k];
      if (wanted == no_column) continue;
      const bool is_its_time = wanted == time_column;
      const double value = unit * number_at(fields, k, is_its_time ? "time" : "value");
      if (is_its_time && names_.empty() && !series_.time.empty() && value <= series_.time.back()) {
        wrong(
            "its time, {:.9g} s, is not after that of line {}, {:.9g} s; put the lines in order of time, and keep one "
            "of two with the same time",
            value, series_.line.back(), series_.time.back());
      }
      (is_its_time ? series_.time : series_.columns[wanted]).push_back(value);
    }
    series_.line.push_back(static_cast<int>(line_));
  }

  void take_header(const std::vector<std::string_view>& fields) {
    if (std::ranges::any_of(fields, [](auto field) { return number_in_field(field).has_value(); })) {
      wrong("has numbers where the columns must be named; begin the file with a line as \"{}\"", example());
    }
    // This test comes first, because messages must not quote a file that is no such series.
    if (std::ranges::none_of(fields, [](auto field) { return is_time(Heading(field)); })) {
      wrong("does not name the column t; name t and at least one other column, as in \"{}\"", example());
    }
    if (!names_.empty()) {
      choose_measured(fields);
      return;
    }
    for (const std::string_view field : fields) found_.push_back(column_named(field));
    for (auto at = found_.begin(); at != found_.end(); ++at) {
      if (std::ranges::find(found_.begin(), at, at->wanted, &Found::wanted) != at) {
        wrong("names column \"{}\" twice; keep one", at->wanted == time_column ? "t" : wanted_[at->wanted].name);
      }
    }
    if (found_.size() < 2) {
      wrong("does not name any column but t; name at least one other, as in \"{}\"", example());
    }
  }

  /// Selects the column of time, the measured one, and that of the places, if it is needed.
  void choose_measured(const std::vector<std::string_view>& fields) {
    std::vector<std::string> headings;
    for (const std::string_view field : fields) headings.push_back(Heading(field).name);
    found_.assign(fields.size(), {no_column, 1.0});
    for (std::size_t column = 1; column < wanted_.size(); ++column) {
      const auto at = std::ranges::find(headings, wanted_[column].name) - headings.begin();
      if (at == std::ssize(headings)) {
        wrong("has no column \"{}\", the places along the profile; name it, as in \"{}\"", wanted_[column].name,
              example());
      }
      found_[static_cast<std::size_t>(at)] = value_column(column, fields[static_cast<std::size_t>(at)]);
    }
    const auto names_time = [](auto field) { return is_time(Heading(field)); };
    if (std::ranges::count_if(fields, names_time) > 1) {
      wrong("names more than one column of time; keep the one that the values go with");
    }
    const auto time = std::ranges::find_if(fields, names_time) - fields.begin();
    auto measured = std::ranges::find_if(names_, [&](std::string_view name) {
      return std::ranges::find(headings, lower_case_of(name)) != headings.end();
    });
    std::ptrdiff_t place = 0;
    if (measured != names_.end()) {
      place = std::ranges::find(headings, lower_case_of(*measured)) - headings.begin();
    } else if (fields.size() == 2 && wanted_.size() == 1) {
      place = 1 - time;
    } else {
      wrong("has no column \"{}\"; call the one that is to be compared so, as in \"{}\"", names_.front(), example());
    }
    found_[static_cast<std::size_t>(time)] = column_named(fields[static_cast<std::size_t>(time)]);
    found_[static_cast<std::size_t>(place)] = value_column(0, fields[static_cast<std::size_t>(place)]);
  }

  static bool is_time(const Heading& heading) { return heading.name == "t" || heading.name == "time"; }

  Found column_named(std::string_view field) const {
    const Heading heading(field);
    if (is_time(heading)) {
      return {time_column, unit_of(heading, field, time_units).value_or(1.0)};
    }
    const auto known = std::ranges::find(wanted_, heading.name, &SeriesColumn::name);
    if (known == wanted_.end()) {
      wrong(
          "has a column \"{}\", which is none of those that count here, \"{}\"; correct its name, or remove the column",
          field, example());
    }
    return value_column(static_cast<std::size_t>(known - wanted_.begin()), field);
  }

  Found value_column(std::size_t wanted, std::string_view field) const {
    const SeriesColumn& column = wanted_[wanted];
    const Heading heading(field);
    const std::span<const Unit> units = units_of(column);
    const std::optional<double> unit = unit_of(heading, field, units);
    const bool needs_unit = column.measure != Measure::length && column.measure != Measure::speed;
    if (!unit && needs_unit) {
      wrong("column \"{}\" has no unit; write {} [{}]", field, heading.name, units.front().name);
    }
    return {wanted, unit.value_or(1.0)};
  }

  std::span<const SeriesColumn> wanted_;
  std::span<const std::string_view> names_;  ///< empty: all columns are requested
  std::vector<Found> found_;
  TimeSeries series_;
};

TimeSeries by_time(const TimeSeries& measured) {
  std::vector<std::size_t> order(measured.time.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return measured.time[k]; });
  TimeSeries sorted{.file = measured.file, .line = {}, .time = {}, .columns = {}};
  sorted.columns.resize(measured.columns.size());
  for (const std::size_t k : order) {
    sorted.line.push_back(measured.line[k]);
    sorted.time.push_back(measured.time[k]);
    for (std::size_t c = 0; c < measured.columns.size(); ++c) sorted.columns[c].push_back(measured.columns[c][k]);
  }
  return sorted;
}

/// Averages the values of one time.
TimeSeries one_of_each_time(const TimeSeries& sorted) {
  TimeSeries means{.file = sorted.file, .line = {}, .time = {}, .columns = {{}}};
  for (std::size_t begin = 0, end = 0; begin < sorted.time.size(); begin = end) {
    double sum = 0.0;
    while (end < sorted.time.size() && sorted.time[end] == sorted.time[begin]) sum += sorted.columns[0][end++];
    means.line.push_back(sorted.line[begin]);
    means.time.push_back(sorted.time[begin]);
    means.columns[0].push_back(sum / static_cast<double>(end - begin));
  }
  return means;
}

}  // namespace

TimeSeries parse_series(const std::filesystem::path& path, std::istream& file, std::span<const SeriesColumn> columns) {
  return SeriesFile(path, columns).read(file);
}

TimeSeries parse_measured_series(const std::filesystem::path& path, std::istream& file,
                                 std::span<const std::string_view> names, Measure measure, Samples samples) {
  std::vector<std::string_view> all(names.begin(), names.end());
  all.push_back("value");
  const std::array<SeriesColumn, 2> columns{{{names.front(), measure}, {"x"}}};
  if (samples == Samples::of_profiles) return by_time(SeriesFile(path, columns, all).read(file));
  return one_of_each_time(by_time(SeriesFile(path, std::span(columns).first(1), all).read(file)));
}

}  // namespace tailwater
