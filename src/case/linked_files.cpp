#include "case/linked_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "case/expression.h"

namespace tailwater {
namespace {

constexpr std::size_t most_points = 10000;  // as many as a list of points in the case may have

constexpr std::size_t most_samples = 1000000;

/// bytes; 1600 for each of the points that a file may have, and read in a moment
constexpr std::uintmax_t largest_points_file = std::uintmax_t{1} << 24;
/// bytes; five million triangles of binary STL, which is far more than walls can be sampled from
constexpr std::uintmax_t largest_mesh_file = std::uintmax_t{1} << 28;
/// bytes; 64 for each of the samples
constexpr std::uintmax_t largest_series_file = std::uintmax_t{1} << 26;

struct Unit {
  std::string_view name;
  double factor;  ///< in SI units
};
constexpr std::array<Unit, 5> length_units{{{"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"ft", 0.3048}}};
constexpr std::array<Unit, 4> time_units{{{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"h", 3600.0}}};
constexpr std::array<Unit, 2> angle_units{{{"rad", 1.0}, {"deg", std::numbers::pi / 180.0}}};
constexpr std::array<Unit, 3> speed_units{{{"m/s", 1.0}, {"cm/s", 1e-2}, {"mm/s", 1e-3}}};
constexpr std::array<Unit, 6> discharge_units{
    {{"m^3/s", 1.0}, {"m3/s", 1.0}, {"m^2/s", 1.0}, {"m2/s", 1.0}, {"l/s", 1e-3}, {"m^3/h", 1.0 / 3600.0}}};
constexpr std::array<std::string_view, 4> names_along{"x", "station", "chainage", "distance"};
constexpr std::array<std::string_view, 5> names_up{"y", "z", "elevation", "height", "level"};

std::ifstream open_file(const std::filesystem::path& path, std::uintmax_t largest) {
  std::error_code error;  // what does not exist is told below
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) {
    throw IoError(fmt::format("{}: is a folder; give a file in it", path.string()));
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw IoError(fmt::format("{}: is a device or a pipe; give a file", path.string()));
  }
  if (const std::uintmax_t size = std::filesystem::file_size(path, error); !error && size > largest) {
    throw InputError(
        fmt::format("{}: has {} bytes; such a file has at most {}: give fewer points, samples or triangles",
                    path.string(), size, largest));
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw IoError(fmt::format("{}: cannot read it ({}); check the name, which is relative to the case file",
                              path.string(), std::generic_category().message(errno)));
  }
  return file;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\"'";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The fields of a line; with a blank as separator any number of blanks is one.
std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    const std::string_view field = trimmed(line.substr(begin, end - begin));
    if (separator != ' ' || !field.empty()) fields.push_back(field);
    begin = end + 1;
  }
  return fields;
}

char separator_of(std::string_view line) {
  for (const char separator : {';', '\t', ','}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

std::optional<double> number_in_field(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return value;
}

/// What the header says about a column: "Station [mm]" is "station" in "mm".
struct Heading {
  std::string name;
  std::string unit;
  bool has_brackets = false;  ///< otherwise what follows an underscore may be part of the name

  explicit Heading(std::string_view field) {
    std::string text(field);
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::size_t bracket = text.find_first_of("[(");
    has_brackets = bracket != std::string::npos;
    const std::size_t end = has_brackets ? bracket : text.rfind('_');
    name = trimmed(std::string_view(text).substr(0, end));
    if (end == std::string::npos) return;
    const std::size_t unit_end = has_brackets ? text.find_first_of("])", end) : text.size();
    unit = trimmed(std::string_view(text).substr(end + 1, unit_end - end - 1));
  }
};

/// A text file of columns, line by line, with the place of what is wrong in it.
class ColumnFile {
 public:
  explicit ColumnFile(const std::filesystem::path& path) : path_(path.string()) {}

 protected:
  /// Calls take(line) for each line that is neither empty nor a comment.
  template <class Take>
  void for_each_line(std::istream& file, Take&& take) {
    for (std::string text; std::getline(file, text);) {
      ++line_;
      if (text.find('\0') != std::string::npos) wrong("is not a text file; export it as CSV");
      std::string_view line = text;
      if (line_ == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);  // byte order mark
      line = trimmed(line);
      if (line.empty() || line.starts_with('#')) continue;
      take(line);
    }
  }

  [[noreturn]] void wrong(const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", path_, line_, message));
  }

  double number_at(const std::vector<std::string_view>& fields, std::size_t column, std::string_view quantity) const {
    if (column >= fields.size()) {
      wrong(fmt::format("has {} columns where column {} is needed; complete the line, or remove it", fields.size(),
                        column + 1));
    }
    const std::optional<double> value = number_in_field(fields[column]);
    if (!value) {
      const bool has_comma = fields[column].find(',') != std::string_view::npos;
      wrong(fmt::format("\"{}\" is not a number; {}", fields[column].substr(0, 40),
                        has_comma ? "write decimals with a point" : "correct it, or begin comments with #"));
    }
    if (!std::isfinite(*value) || std::abs(*value) > largest_number)
      wrong(fmt::format("{} is no finite {}; correct it", fields[column], quantity));
    return *value;
  }

  /// The unit of a heading in SI units; nothing if it names none.
  std::optional<double> unit_of(const Heading& heading, std::string_view field, std::span<const Unit> units) const {
    if (heading.unit.empty()) return std::nullopt;
    const auto known = std::ranges::find(units, heading.unit, &Unit::name);
    if (known != units.end()) return known->factor;
    if (!heading.has_brackets) return std::nullopt;
    std::vector<std::string_view> names;
    for (const Unit& unit : units) names.push_back(unit.name);
    const std::string_view last = names.back();
    names.pop_back();
    wrong(fmt::format("column \"{}\" has the unknown unit \"{}\"; use {} or {}", field, heading.unit,
                      fmt::join(names, ", "), last));
  }

  std::string path_;
  std::size_t line_ = 0;
  char separator_ = '\0';  ///< not known yet
};

/// A column by its name in the header.
struct Column {
  std::string name;
  double unit = 1.0;  ///< m
};

/// The first two columns of a file without header.
struct Columns {
  std::size_t along = 0;
  std::size_t up = 1;
  double unit_along = 1.0;
  double unit_up = 1.0;
};

class PointsFile : ColumnFile {
 public:
  using ColumnFile::ColumnFile;

  std::vector<Coordinates> read(std::istream& file) {
    for_each_line(file, [this](std::string_view line) { take(line); });
    if (points_.empty()) wrong("has no points; give lines of two numbers, such as 0.5, 1.25");
    return std::move(points_);
  }

 private:
  void take(std::string_view line) {
    if (separator_ == '\0') {
      separator_ = separator_of(line);
      const std::vector<std::string_view> fields = split(line, separator_);
      if (!fields.empty() &&
          std::ranges::none_of(fields, [](auto field) { return number_in_field(field).has_value(); })) {
        columns_ = columns_named(fields);
        return;
      }
      if (fields.size() > 2) {
        wrong(
            fmt::format("has {} columns and no line that names them; begin the file with such a line, as in \"x [m], "
                        "z [m]\", or give two columns",
                        fields.size()));
      }
    }
    const std::vector<std::string_view> fields = split(line, separator_);
    if (points_.size() == most_points) {
      wrong(fmt::format("has more than {} points; a wall has at most that many: give fewer, or several walls",
                        most_points));
    }
    points_.push_back({columns_.unit_along * number_at(fields, columns_.along, "length"),
                       columns_.unit_up * number_at(fields, columns_.up, "length")});
  }

  Column column_named(std::string_view field) const {
    const Heading heading(field);
    const std::optional<double> unit = unit_of(heading, field, length_units);
    if (unit || heading.has_brackets) return {heading.name, unit.value_or(1.0)};
    std::string text(field);  // an underscore in a name
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return {text};
  }

  Columns columns_named(const std::vector<std::string_view>& fields) const {
    if (fields.size() < 2) wrong("names one column; two are needed, as in \"x [m], z [m]\"");
    std::vector<Column> named;
    for (const std::string_view field : fields) named.push_back(column_named(field));
    const auto find = [&](const auto& names) {
      std::vector<std::size_t> found;
      for (std::size_t k = 0; k < named.size(); ++k) {
        if (std::ranges::find(names, named[k].name) != names.end()) found.push_back(k);
      }
      return found;
    };
    const std::vector<std::size_t> along = find(names_along);
    const std::vector<std::size_t> up = find(names_up);
    Columns columns;
    if (along.size() == 1 && up.size() == 1) {
      columns = {along[0], up[0]};
    } else if (fields.size() > 2) {
      wrong(fmt::format("of its {} columns {} are named {}, and {} are named {}; name one of each", fields.size(),
                        along.size(), fmt::join(names_along, ", "), up.size(), fmt::join(names_up, ", ")));
    }
    columns.unit_along = named[columns.along].unit;
    columns.unit_up = named[columns.up].unit;
    return columns;
  }

  Columns columns_;
  std::vector<Coordinates> points_;
};

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
      take_header(split(line, separator_));
      return;
    }
    const std::vector<std::string_view> fields = split(line, separator_);
    if (series_.time.size() == most_samples) {
      wrong(fmt::format("has more than {} lines of numbers; give fewer", most_samples));
    }
    for (std::size_t k = 0; k < found_.size(); ++k) {
      const auto [wanted, unit] = found_[k];
      const bool is_time = wanted == time_column;
      const double value = unit * number_at(fields, k, is_time ? "time" : "value");
      if (is_time && !series_.time.empty() && value <= series_.time.back()) {
        wrong(
            fmt::format("its time, {:.9g} s, is not after that of line {}, {:.9g} s; put the lines in order of time, "
                        "and keep one of two with the same time",
                        value, series_.line.back(), series_.time.back()));
      }
      (is_time ? series_.time : series_.columns[wanted]).push_back(value);
    }
    series_.line.push_back(static_cast<int>(line_));
  }

  void take_header(const std::vector<std::string_view>& fields) {
    if (std::ranges::any_of(fields, [](auto field) { return number_in_field(field).has_value(); })) {
      wrong(
          fmt::format("has numbers where the columns must be named; begin the file with a line as \"{}\"", example()));
    }
    for (const std::string_view field : fields) found_.push_back(column_named(field));
    for (auto at = found_.begin(); at != found_.end(); ++at) {
      if (std::ranges::find(found_.begin(), at, at->wanted, &Found::wanted) != at) {
        wrong(fmt::format("names column \"{}\" twice; keep one",
                          at->wanted == time_column ? "t" : wanted_[at->wanted].name));
      }
    }
    const bool has_time = std::ranges::find(found_, time_column, &Found::wanted) != found_.end();
    if (!has_time || found_.size() < 2) {
      wrong(fmt::format("does not name {}; name t and at least one other column, as in \"{}\"",
                        has_time ? "any column but t" : "the column t", example()));
    }
  }

  Found column_named(std::string_view field) const {
    const Heading heading(field);
    if (heading.name == "t" || heading.name == "time") {
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

std::vector<Coordinates> read_points_file(const std::filesystem::path& path) {
  std::ifstream file = open_file(path, largest_points_file);
  return PointsFile(path).read(file);
}

TimeSeries read_time_series(const std::filesystem::path& path, std::span<const SeriesColumn> columns) {
  std::ifstream file = open_file(path, largest_series_file);
  return SeriesFile(path, columns).read(file);
}

std::string checksum_of_file(const std::filesystem::path& path) {
  std::ifstream file = open_file(path, largest_mesh_file);
  std::vector<char> block(1 << 20);
  uLong sum = crc32(0, nullptr, 0);
  do {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    sum = crc32(sum, reinterpret_cast<const Bytef*>(block.data()), static_cast<uInt>(file.gcount()));
  } while (file);
  return fmt::format("{:08x}", sum);
}

}  // namespace tailwater
