#include "case_files/column_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/number_range.h"
#include "base/text.h"

namespace tailwater {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\"'";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Whether a text is short and probably meant as a number, as "1,5" or "0.3m".
bool is_like_a_number(std::string_view field) {
  constexpr std::size_t longest = 20;
  return field.size() <= longest && std::ranges::all_of(field, [](unsigned char letter) {
           return std::isalnum(letter) != 0 ||
                  std::string_view("+-.,_%").find(static_cast<char>(letter)) != std::string_view::npos;
         });
}

}  // namespace

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (const std::string_view part : split(line, separator)) {
    const std::string_view field = trimmed(part);
    if (separator != ' ' || !field.empty()) fields.push_back(field);
  }
  while (fields.size() > 1 && fields.back().empty()) fields.pop_back();
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

std::string lower_case_of(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

Heading::Heading(std::string_view field) {
  const std::string text = lower_case_of(field);
  const std::size_t bracket = text.find_first_of("[(");
  has_brackets = bracket != std::string::npos;
  const std::size_t end = has_brackets ? bracket : text.rfind('_');
  name = trimmed(std::string_view(text).substr(0, end));
  if (end == std::string::npos) return;
  const std::size_t unit_end = has_brackets ? text.find_first_of("])", end) : text.size();
  unit = trimmed(std::string_view(text).substr(end + 1, unit_end - end - 1));
}

std::string_view ColumnFile::next_line(std::string_view text) {
  ++line_;
  if (text.find('\0') != std::string_view::npos) wrong("is not a text file; export it as CSV");
  if (line_ == 1 && text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  const std::string_view line = trimmed(text);
  return line.starts_with('#') ? std::string_view() : line;
}

void ColumnFile::wrong(const std::string& message) const { throw InputError("{}:{}: {}", path_, line_, message); }

std::vector<std::string_view> ColumnFile::numbers_of(std::string_view line) const {
  std::vector<std::string_view> fields = fields_of(line, separator_);
  if (fields.size() > width_) {
    wrong(
        "has {} columns, and the first line has {}; {}", fields.size(), width_,
        separator_ == ','
            ? "if the comma is that of decimals, write them with a point; otherwise name all columns in the first line"
            : "name all columns in the first line");
  }
  return fields;
}

double ColumnFile::number_at(const std::vector<std::string_view>& fields, std::size_t column,
                             std::string_view quantity) const {
  if (column >= fields.size()) {
    wrong("has {} columns where column {} is needed; complete the line, or remove it", fields.size(), column + 1);
  }
  const std::string_view field = fields[column];
  const std::optional<double> value = number_in_field(field);
  if (!value) {
    const bool has_comma = field.find(',') != std::string_view::npos;
    const std::string what =
        is_like_a_number(field) ? fmt::format("\"{}\"", field) : fmt::format("the entry in column {}", column + 1);
    wrong("{} is not a number; {}", what,
          has_comma ? "write decimals with a point" : "correct it, or begin comments with #");
  }
  if (!std::isfinite(*value) || std::abs(*value) > largest_number)
    wrong("{} is no finite {}; correct it", field, quantity);
  return *value;
}

std::optional<double> ColumnFile::unit_of(const Heading& heading, std::string_view field,
                                          std::span<const Unit> units) const {
  if (heading.unit.empty()) return std::nullopt;
  const auto known = std::ranges::find(units, heading.unit, &Unit::name);
  if (known != units.end()) return known->factor;
  if (!heading.has_brackets) return std::nullopt;
  std::vector<std::string_view> names;
  for (const Unit& unit : units) names.push_back(unit.name);
  const std::string_view last = names.back();
  names.pop_back();
  wrong("column \"{}\" has the unknown unit \"{}\"; use {} or {}", field, heading.unit, fmt::join(names, ", "), last);
}

}  // namespace tailwater
