#include "case/series_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "case/column_file.h"

namespace tailwater {
namespace {

constexpr std::size_t most_samples = 1000000;

constexpr std::array<Unit, 4> time_units{{{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"h", 3600.0}}};
constexpr std::array<Unit, 2> angle_units{{{"rad", 1.0}, {"deg", std::numbers::pi / 180.0}}};
constexpr std::array<Unit, 3> speed_units{{{"m/s", 1.0}, {"cm/s", 1e-2}, {"mm/s", 1e-3}}};
constexpr std::array<Unit, 6> discharge_units{
    {{"m^3/s", 1.0}, {"m3/s", 1.0}, {"m^2/s", 1.0}, {"m2/s", 1.0}, {"l/s", 1e-3}, {"m^3/h", 1.0 / 3600.0}}};

class SeriesFile : ColumnFile {
 public:
  SeriesFile(const std::filesystem::path& path, std::span<const SeriesColumn> columns)
      : ColumnFile(path), wanted_(columns) {
    series_.file = path.string();
    series_.columns.resize(columns.size());
  }

  TimeSeries read(std::istream& file) {
    for_each_line(file, [this](std::string_view line) { take(line); });
    if (series_.time.size() < 2) {
      wrong(
          fmt::format("the file has {} lines of numbers; give at least two, with a line before them that names the "
                      "columns, as in \"{}\"",
                      series_.time.size(), example()));
    }
    return std::move(series_);
  }

 private:
  static constexpr std::size_t time_column = static_cast<std::size_t>(-1);

  /// One column of the file: which of those wanted it is, and its unit.
  struct Found {
    std::size_t wanted;
    double unit;
  };

  /// The first is the SI unit.
  static std::span<const Unit> units_of(const SeriesColumn& column) {
    switch (column.measure) {
      case Measure::angle:
        return angle_units;
      case Measure::speed:
        return speed_units;
      case Measure::discharge:
        return discharge_units;
      case Measure::length:
        break;
    }
    return length_units;
  }

  /// A header as it could be.
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
    if (series_.time.size() == most_samples) {
      wrong(fmt::format("has more than {} lines of numbers; give fewer", most_samples));
    }
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const auto [wanted, unit] = found_[k];
      const bool is_its_time = wanted == time_column;
      const double value = unit * number_at(fields, k, is_its_time ? "time" : "value");
      if (is_its_time && !series_.time.empty() && value <= series_.time.back()) {
        wrong(
            fmt::format("its time, {:.9g} s, is not after that of line {}, {:.9g} s; put the lines in order of time, "
                        "and keep one of two with the same time",
                        value, series_.line.back(), series_.time.back()));
      }
      (is_its_time ? series_.time : series_.columns[wanted]).push_back(value);
    }
    series_.line.push_back(static_cast<int>(line_));
  }

  void take_header(const std::vector<std::string_view>& fields) {
    if (std::ranges::any_of(fields, [](auto field) { return number_in_field(field).has_value(); })) {
      wrong(
          fmt::format("has numbers where the columns must be named; begin the file with a line as \"{}\"", example()));
    }
    // First of all, because nothing is quoted from a file that is no such series.
    if (std::ranges::none_of(fields, [](auto field) { return is_time(Heading(field)); })) {
      wrong(fmt::format("does not name the column t; name t and at least one other column, as in \"{}\"", example()));
    }
    for (const std::string_view field : fields) found_.push_back(column_named(field));
    for (auto at = found_.begin(); at != found_.end(); ++at) {
      if (std::ranges::find(found_.begin(), at, at->wanted, &Found::wanted) != at) {
        wrong(fmt::format("names column \"{}\" twice; keep one",
                          at->wanted == time_column ? "t" : wanted_[at->wanted].name));
      }
    }
    if (found_.size() < 2) {
      wrong(fmt::format("does not name any column but t; name at least one other, as in \"{}\"", example()));
    }
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
          fmt::format("has a column \"{}\", which is none of those that count here, \"{}\"; correct its name, or "
                      "remove the column",
                      field, example()));
    }
    const auto wanted = static_cast<std::size_t>(known - wanted_.begin());
    const std::span<const Unit> units = units_of(*known);
    const std::optional<double> unit = unit_of(heading, field, units);
    const bool needs_unit = known->measure == Measure::angle || known->measure == Measure::discharge;
    if (!unit && needs_unit) {
      wrong(fmt::format("column \"{}\" has no unit; write {} [{}]", field, known->name, units.front().name));
    }
    return {wanted, unit.value_or(1.0)};
  }

  std::span<const SeriesColumn> wanted_;
  std::vector<Found> found_;
  TimeSeries series_;
};

}  // namespace

TimeSeries parse_series(const std::filesystem::path& path, std::istream& file, std::span<const SeriesColumn> columns) {
  return SeriesFile(path, columns).read(file);
}

}  // namespace tailwater
