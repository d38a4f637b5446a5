#include "case/table_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "base/error.h"
#include "base/number_range.h"
#include "base/text.h"
#include "case/nearest_name.h"
#include "case/removed_keys.h"
#include "case/time_function.h"

namespace tailwater {

namespace {

/// Whether a number that cannot be negative is so near to 0 that a quotient by it could overflow.
bool is_too_small(double value, const Range& range) {
  return range.low == 0.0 && value > 0.0 && value < smallest_number;
}

constexpr const char* unseen = "has a control character or an end of a line; use printable characters on one line";

/// Whether the expression of a level has the name of the discharge, which is also that of one of the numbers.
bool has_ambiguous_discharge(const std::string& text, NamedNumbers numbers) {
  if (numbers.erase(std::string(level_names[1])) == 0) return false;
  try {
    Formula(text, numbers, time_name);
    return false;
  } catch (const ExpressionError& error) {
    return error.unknown_name() == level_names[1];
  }
}

}  // namespace

std::string home_of(std::string_view key) {
  std::vector<std::string> homes;
  for (const TableInfo& table : case_tables()) {
    for (const KeyInfo& info : table.keys) {
      if (info.key == key) homes.push_back(table.heading());
    }
  }
  return homes.empty() ? "" : fmt::format("it belongs to {}; ", fmt::join(homes, " or "));
}

std::optional<double> number_in(const toml::node& node) {
  if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
  return node.value<double>();
}

std::string in_unit(std::string_view unit) { return unit.empty() ? "" : fmt::format(" in {}", unit); }

void TableReader::text(std::string_view key, std::string& value, std::string_view doc, Presence presence) {
  if (const toml::node* node = find(key, doc, "", "", presence)) {
    if (const auto* given = node->as_string(); given != nullptr && !is_printable(given->get())) {
      wrong("text-not-printable", key, *node, unseen);
    } else if (given != nullptr) {
      value = given->get();
    } else {
      wrong("text-expected", key, *node, "give a text in quotes");
    }
  }
}

void TableReader::integer(std::string_view key, int& value, std::string_view unit, const Range& range,
                          std::string_view doc, Presence presence) {
  const toml::node* node = find(key, doc, unit, range_text(range), presence);
  const auto given = node == nullptr ? std::nullopt : evaluated(key, key, *node, unit);
  if (!given) return;
  const bool is_int = std::trunc(*given) == *given && std::abs(*given) <= std::numeric_limits<int>::max();
  if (is_int && range.contains(*given)) {
    value = static_cast<int>(*given);
  } else {
    wrong("whole-number-expected", key, *node,
          fmt::format("not a whole number in the permitted range; give a whole number, {}{}", range_text(range),
                      in_unit(unit)));
  }
}

void TableReader::number(std::string_view key, double& value, std::string_view unit, const Range& range,
                         std::string_view doc, Presence presence) {
  const toml::node* node = find(key, doc, unit, range_text(range), presence);
  const auto given = node == nullptr ? std::nullopt : evaluated(key, key, *node, unit);
  if (!given) return;
  if (is_too_small(*given, range)) {
    wrong("number-too-small", key, *node,
          fmt::format("implausibly small; give {}a number of at least {:g}{}", range.low_is_excluded ? "" : "0 or ",
                      smallest_number, in_unit(unit)));
  } else if (range.contains(*given)) {
    value = *given;
  } else {
    const std::string result = node->is_string() ? fmt::format("its value {} is ", *given) : "";
    wrong("number-out-of-range", key, *node,
          fmt::format("{}out of range; give a number {}{}", result, range_text(range), in_unit(unit)));
  }
}

void TableReader::coordinates(std::string_view key, Coordinates& value, std::string_view unit, std::string_view doc,
                              Presence presence) {
  if (const toml::node* node = find(key, doc, unit, "", presence)) {
    if (auto given = point(key, std::string(key), *node, unit)) value = std::move(*given);
  }
}

void TableReader::varying(std::string_view key, Varying& value, Variables variables, std::string_view unit,
                          std::string_view doc) {
  if (const toml::node* node = find(key, doc, unit, "", Presence::optional)) {
    if (auto given = read_varying(key, std::string(key), *node, variables, unit)) value = std::move(*given);
  }
}

void TableReader::varying(std::string_view key, std::optional<Varying>& value, Variables variables,
                          std::string_view unit, std::string_view doc) {
  const toml::node* node = find(key, doc, unit, "", Presence::optional);
  if (node == nullptr || node->value_or(std::string_view("-")).empty()) return;
  if (auto given = read_varying(key, std::string(key), *node, variables, unit)) value = std::move(*given);
}

void TableReader::field(std::string_view key, VectorField& value, Variables variables, std::string_view unit,
                        std::string_view doc) {
  const toml::node* node = find(key, doc, unit, "", Presence::optional);
  const toml::array* list = node == nullptr ? nullptr : components(key, std::string(key), *node, unit);
  if (list == nullptr) return;
  VectorField given;
  for (std::size_t i = 0; i < list->size(); ++i) {
    if (auto component = read_varying(key, fmt::format("{}[{}]", key, i), (*list)[i], variables, unit)) {
      given.push_back(std::move(*component));
    }
  }
  if (given.size() == list->size()) value = std::move(given);
}

const toml::array* TableReader::list_at(std::string_view key, const toml::node* node, const std::string& wanted) {
  if (node != nullptr && !node->is_array()) wrong("list-expected", key, *node, wanted);
  return node == nullptr ? nullptr : node->as_array();
}

void TableReader::points(std::string_view key, std::vector<Coordinates>& value, std::string_view unit,
                         std::string_view doc) {
  const toml::node* node = find(key, doc, unit, "", Presence::optional);
  const toml::array* list =
      list_at(key, node, fmt::format("give a list of points{}, such as [[0, 0], [1, 0]]", in_unit(unit)));
  if (list == nullptr) return;
  constexpr std::size_t most = 10000;  // faces are compared with one another
  if (list->size() > most) {
    wrong("shape-too-many-points", key, *node,
          fmt::format("has {} points; a shape has at most {}: give fewer, or several shapes", list->size(), most));
    return;
  }
  std::vector<Coordinates> given;
  for (std::size_t i = 0; i < list->size(); ++i) {
    if (auto corner = point(key, fmt::format("{}[{}]", key, i), (*list)[i], unit)) given.push_back(std::move(*corner));
  }
  value = std::move(given);
}

void TableReader::numbers(std::string_view key, std::vector<double>& value, std::string_view unit,
                          std::string_view doc) {
  const toml::node* node = find(key, doc, unit, "", Presence::optional);
  const toml::array* list =
      list_at(key, node, fmt::format("give a list of numbers{}, such as [0.5, 1.0]", in_unit(unit)));
  if (list == nullptr) return;
  if (auto given = elements(key, std::string(key), *list, unit)) value = std::move(*given);
}

void TableReader::texts(std::string_view key, std::vector<std::string>& value,
                        std::span<const std::string_view> allowed, std::string_view doc) {
  const toml::node* node = find(key, doc, "", quoted_list(allowed), Presence::optional);
  const std::string choice = allowed.empty() ? "names in quotes" : fmt::format("any of {}", quoted_list(allowed));
  const bool is_one = node != nullptr && node->is_string();
  const toml::array* list = is_one ? nullptr : list_at(key, node, fmt::format("give a list of {}", choice));
  if (!is_one && list == nullptr) return;
  std::vector<std::string> given;
  for (std::size_t i = 0; i < (is_one ? 1 : list->size()); ++i) {
    const toml::node& element = is_one ? *node : (*list)[i];
    const std::string place = is_one ? std::string(key) : fmt::format("{}[{}]", key, i);
    const auto* name = element.as_string();
    if (name == nullptr) {
      wrong("list-entry-not-text", key, element, fmt::format("give {}", choice), place);
    } else if (!is_printable(name->get())) {
      wrong("text-not-printable", key, element, unseen, place);
    } else if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), name->get()) == allowed.end()) {
      wrong("list-entry-unknown", key, element,
            fmt::format("unknown name; {}", unknown_name_hint(name->get(), allowed)), place);
    } else if (std::find(given.begin(), given.end(), name->get()) != given.end()) {
      wrong("list-entry-twice", key, element, "is in the list twice; remove one", place);
    } else {
      given.push_back(name->get());
    }
  }
  value = std::move(given);
}

std::filesystem::path TableReader::linked(const std::string& file) const {
  if (file.empty()) throw InputError("names no file; give its name, relative to the case file");
  std::error_code error;
  const std::filesystem::path path = std::filesystem::absolute(context_.folder / file, error);
  if (error) throw InputError("cannot identify this file: {}", error.message());
  if (!is_printable(path.string())) {
    throw InputError(
        "the name of its folder, {}, has letters that are not UTF-8, or that cannot be shown; move the case into "
        "another folder",
        path.string());
  }
  return path.lexically_normal();
}

void TableReader::wrong(MessageId id, std::string_view key, const toml::node& node, const std::string& message,
                        std::string_view place) {
  context_.keys_wrong.insert(full(key));
  context_.problems.wrong(id, table_.with_key(key), node, message, place);
}

void TableReader::missing(MessageId id, std::string_view key, const std::string& message) {
  context_.keys_wrong.insert(full(key));
  context_.problems.add(id, source_ == nullptr ? nullptr : &source_->source(), table_.with_key(key),
                        fmt::format("{} is missing; {}", full(key), message));
}

void TableReader::report_unknown_keys(std::span<const KeyInfo> keys) {
  if (source_ == nullptr) return;
  std::vector<std::string_view> valid;
  for (const KeyInfo& info : keys) valid.push_back(info.key);
  for (const auto& [key, node] : *source_) {
    if (std::find(valid.begin(), valid.end(), key.str()) == valid.end()) {
      const std::string fate = fate_of(table_.table, key.str());
      wrong("key-unknown", key.str(), node,
            fate.empty() ? fmt::format("unknown key; {}{}", home_of(key.str()), unknown_name_hint(key.str(), valid))
                         : fate);
    }
  }
}

const toml::node* TableReader::find(std::string_view key, std::string_view doc, std::string_view unit,
                                    std::string_view allowed, Presence presence) {
  const bool is_not_now = !only_.empty() && std::find(only_.begin(), only_.end(), key) == only_.end();
  if (is_not_now || context_.keys_done.contains(full(key))) return nullptr;
  const toml::node* node = given(key);
  if (node == nullptr && presence == Presence::required) {
    missing("key-missing", key,
            fmt::format("add it to {}: {}{}{}{}", table_, doc, allowed.empty() ? "" : "; ", allowed, in_unit(unit)));
  }
  return node;
}

std::optional<std::size_t> TableReader::chosen(std::string_view key, std::span<const std::string_view> names,
                                               std::string_view doc, Presence presence) {
  const toml::node* node = find(key, doc, "", quoted_list(names), presence);
  if (node == nullptr) return std::nullopt;
  const auto* name = node->as_string();
  if (name == nullptr) {
    wrong("choice-not-text", key, *node, fmt::format("give one of {}", quoted_list(names)));
    return std::nullopt;
  }
  const auto found = std::find(names.begin(), names.end(), name->get());
  if (found == names.end()) {
    wrong("choice-unknown", key, *node, fmt::format("unknown choice; {}", unknown_name_hint(name->get(), names)));
    return std::nullopt;
  }
  return found - names.begin();
}

std::optional<double> TableReader::evaluated(std::string_view key, std::string_view place, const toml::node& node,
                                             std::string_view unit) {
  std::optional<double> value = number_in(node);
  if (const auto* text = node.as_string()) {
    try {
      value = evaluate(text->get(), context_.numbers);
    } catch (const ExpressionError& error) {
      wrong("expression-invalid", key, node, error.what(), place);
      return std::nullopt;
    }
    if (!std::isfinite(*value)) {
      // The expression uses a parameter without a value, and the error is reported at that parameter.
      context_.keys_wrong.insert(full(key));
      return std::nullopt;
    }
  } else if (!node.is_number()) {
    wrong("number-expected", key, node,
          fmt::format("wrong type; give a number{} or an expression such as \"2*H\"", in_unit(unit)), place);
    return std::nullopt;
  }
  if (!std::isfinite(*value)) {
    wrong("number-not-finite", key, node, fmt::format("not a finite number; give a number{}", in_unit(unit)), place);
    return std::nullopt;
  }
  if (std::abs(*value) > largest_number) {
    wrong("number-too-large", key, node,
          fmt::format("its magnitude is above {:g}, which no quantity of a flow reaches in SI units; give a number{}",
                      largest_number, in_unit(unit)),
          place);
    return std::nullopt;
  }
  return value;
}

std::optional<Varying> TableReader::read_varying(std::string_view key, const std::string& place, const toml::node& node,
                                                 Variables variables, std::string_view unit) {
  // In 2D there is no z; 0: the file gives no valid dimension, which is reported.
  const auto position = std::span(position_names).first(context_.dimension == 2 ? 2 : 3);
  NamedNumbers numbers = context_.numbers;
  const auto names = variables == Variables::time     ? std::span<const std::string_view>(time_name)
                     : variables == Variables::height ? std::span<const std::string_view>(height_name)
                     : variables == Variables::level  ? names_of_level(numbers)
                                                      : position;
  const auto* text = node.as_string();
  if (variables == Variables::height) numbers.erase(std::string(height_name[0]));  // a parameter may have the name
  if (text != nullptr && variables == Variables::level && has_ambiguous_discharge(text->get(), numbers)) {
    wrong("q-is-a-parameter", key, *text,
          "uses q, which would be the discharge of the opening, but the case has a parameter q; rename the parameter "
          "here and in [parameters]",
          place);
    return std::nullopt;
  }
  try {
    if (text != nullptr && Formula(text->get(), numbers, names).uses_variables()) return text->get();
  } catch (const ExpressionError& error) {
    wrong("expression-invalid", key, *text, error.what(), place);
    return std::nullopt;
  }
  return evaluated(key, place, node, unit);
}

std::optional<std::vector<double>> TableReader::elements(std::string_view key, const std::string& place,
                                                         const toml::array& list, std::string_view unit) {
  std::vector<double> values;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (const auto value = evaluated(key, fmt::format("{}[{}]", place, i), list[i], unit)) values.push_back(*value);
  }
  return values.size() == list.size() ? std::optional(values) : std::nullopt;
}

const toml::array* TableReader::components(std::string_view key, const std::string& place, const toml::node& node,
                                           std::string_view unit) {
  const toml::array* list = node.as_array();
  const int dimension = context_.dimension;
  const bool is_right_size = list != nullptr && (dimension == 0 ? list->size() == 2 || list->size() == 3
                                                                : list->size() == static_cast<std::size_t>(dimension));
  if (!is_right_size) {
    const std::string count = dimension == 0 ? "2 or 3" : fmt::format("{}", dimension);
    wrong("vector-expected", key, node,
          fmt::format("give {} numbers{}, one per dimension{}", count, in_unit(unit),
                      dimension == 0 ? "" : fmt::format(" (case.dimension = {})", dimension)),
          place);
    return nullptr;
  }
  return list;
}

std::optional<Coordinates> TableReader::point(std::string_view key, const std::string& place, const toml::node& node,
                                              std::string_view unit) {
  const toml::array* list = components(key, place, node, unit);
  return list == nullptr ? std::nullopt : elements(key, place, *list, unit);
}

}  // namespace tailwater
