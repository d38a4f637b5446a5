#include "case/key_info.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "case/nearest_name.h"

namespace tailwater {

namespace {

std::string array_text(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(toml_float(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string varying_text(const Varying& value) {
  const auto* number = std::get_if<double>(&value);
  return number != nullptr ? toml_float(*number) : toml_string(std::get<std::string>(value));
}

/// Visitor for CaseSpec::describe.
struct TableCollector {
  std::vector<TableInfo> tables_found;

  template <class Table>
  void table(std::string_view name, const Table& table, std::string_view doc) {
    tables_found.push_back({name, false, doc, keys_of(table)});
  }
  template <class Table>
  void tables(std::string_view name, const std::vector<Table>&, std::string_view doc) {
    tables_found.push_back({name, true, doc, keys_of(Table{})});
  }
};

}  // namespace

std::string_view names_of(Variables variables) {
  if (variables == Variables::height) return height_name[0];
  if (variables == Variables::level) return "t, q";
  return variables == Variables::time ? time_name[0] : "x, y, z";
}

std::string range_text(const Range& range) {
  const bool has_low = std::isfinite(range.low);
  const bool has_high = std::isfinite(range.high);
  if (has_low && has_high && !range.low_is_excluded && !range.high_is_excluded) {
    return fmt::format("{} to {}", range.low, range.high);
  }
  std::string text;
  if (has_low) {
    text = fmt::format("{} {}", range.low_is_excluded ? "above" : "at least", range.low);
  }
  if (has_high) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", range.high_is_excluded ? "below" : "at most", range.high);
  }
  return text;
}

void KeyCollector::text(std::string_view key, const std::string& value, std::string_view doc, Presence presence) {
  rows_.push_back({key, "text", toml_string(value), "", "", doc, presence});
}

void KeyCollector::integer(std::string_view key, int value, std::string_view unit, const Range& range,
                           std::string_view doc, Presence presence) {
  rows_.push_back({key, "whole number", fmt::format("{}", value), unit, range_text(range), doc, presence, range});
}

void KeyCollector::number(std::string_view key, double value, std::string_view unit, const Range& range,
                          std::string_view doc, Presence presence) {
  rows_.push_back({key, "number", toml_float(value), unit, range_text(range), doc, presence, range});
}

void KeyCollector::coordinates(std::string_view key, const Coordinates& value, std::string_view unit,
                               std::string_view doc, Presence presence) {
  rows_.push_back({key, "vector", array_text(value), unit, "", doc, presence});
}

void KeyCollector::varying(std::string_view key, const Varying& value, Variables variables, std::string_view unit,
                           std::string_view doc) {
  const std::string type = fmt::format("number or expression of {}", names_of(variables));
  rows_.push_back({key, type, varying_text(value), unit, "", doc, Presence::optional, {}, {}, variables});
}

void KeyCollector::varying(std::string_view key, const std::optional<Varying>& value, Variables variables,
                           std::string_view unit, std::string_view doc) {
  varying(key, value.value_or(Varying(std::string())), variables, unit, doc);
}

void KeyCollector::field(std::string_view key, const VectorField& value, Variables variables, std::string_view unit,
                         std::string_view doc) {
  const std::string type = fmt::format("list of `dimension` numbers or expressions of {}", names_of(variables));
  std::vector<std::string> texts;
  for (const Varying& component : value) texts.push_back(varying_text(component));
  rows_.push_back(
      {key, type, fmt::format("[{}]", fmt::join(texts, ", ")), unit, "", doc, Presence::optional, {}, {}, variables});
}

void KeyCollector::points(std::string_view key, const std::vector<Coordinates>& value, std::string_view unit,
                          std::string_view doc) {
  std::vector<std::string> texts;
  for (const Coordinates& point : value) texts.push_back(array_text(point));
  rows_.push_back({key, "points", fmt::format("[{}]", fmt::join(texts, ", ")), unit, "", doc, Presence::optional});
}

void KeyCollector::numbers(std::string_view key, const std::vector<double>& value, std::string_view unit,
                           std::string_view doc) {
  rows_.push_back({key, "numbers", array_text(value), unit, "", doc, Presence::optional});
}

void KeyCollector::texts(std::string_view key, const std::vector<std::string>& value,
                         std::span<const std::string_view> allowed, std::string_view doc) {
  std::vector<std::string> texts;
  for (const std::string& text : value) texts.push_back(toml_string(text));
  rows_.push_back({key,
                   "texts",
                   fmt::format("[{}]", fmt::join(texts, ", ")),
                   "",
                   quoted_list(allowed),
                   doc,
                   Presence::optional,
                   {},
                   allowed});
}

void KeyCollector::add_choice(std::string_view key, std::string_view value, std::span<const std::string_view> names,
                              std::string_view doc, Presence presence) {
  rows_.push_back({key, "choice", toml_string(value), "", quoted_list(names), doc, presence, {}, names});
}

std::string TableInfo::heading() const { return is_list ? fmt::format("[[{}]]", name) : fmt::format("[{}]", name); }

std::vector<TableInfo> case_tables() {
  TableCollector collector;
  const CaseSpec defaults;
  CaseSpec::describe(defaults, collector);
  return collector.tables_found;
}

}  // namespace tailwater
