#include "case_files/points_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "case_files/column_file.h"

namespace tailwater {
namespace {

constexpr std::size_t max_points = 10000;  // the maximum of a list of points in the case

constexpr std::array<std::string_view, 4> names_along{"x", "station", "chainage", "distance"};
constexpr std::array<std::string_view, 5> names_up{"y", "z", "elevation", "height", "level"};

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
      const std::vector<std::string_view> fields = fields_of(line, separator_);
      width_ = fields.size();
      if (!fields.empty() &&
          std::ranges::none_of(fields, [](auto field) { return number_in_field(field).has_value(); })) {
        columns_ = columns_named(fields);
        return;
      }
      if (fields.size() > 2) {
        wrong(
            "has {} columns and no line that names them; begin the file with such a line, as in \"x [m], z [m]\", or "
            "give two columns",
            fields.size());
      }
    }
    const std::vector<std::string_view> fields = numbers_of(line);
    if (points_.size() == max_points) {
      wrong("has more than {} points; a wall has at most that many: give fewer, or several walls", max_points);
    }
    points_.push_back({columns_.unit_along * number_at(fields, columns_.along, "length"),
                       columns_.unit_up * number_at(fields, columns_.up, "length")});
  }

  Column column_named(std::string_view field) const {
    const Heading heading(field);
    const std::optional<double> unit = unit_of(heading, field, length_units);
    if (unit || heading.has_brackets) return {heading.name, unit.value_or(1.0)};
    return {lower_case_of(field)};  // an underscore in a name
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
      wrong("of its {} columns {} are named {}, and {} are named {}; name one of each", fields.size(), along.size(),
            fmt::join(names_along, ", "), up.size(), fmt::join(names_up, ", "));
    }
    columns.unit_along = named[columns.along].unit;
    columns.unit_up = named[columns.up].unit;
    return columns;
  }

  Columns columns_;
  std::vector<Coordinates> points_;
};

}  // namespace

std::vector<Coordinates> parse_points(const std::filesystem::path& path, std::istream& file) {
  return PointsFile(path).read(file);
}

}  // namespace tailwater
