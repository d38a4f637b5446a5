// The description of the case file as a JSON schema (draft 7), which editors can use.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "base/number_range.h"
#include "case/expression.h"
#include "case/key_info.h"
#include "case/key_use.h"
#include "case/toml_text.h"
#include "case_help/help.h"
#include "case_help/schema_rules.h"

namespace tailwater {
namespace {

/// Excludes texts that are no expression: a number with a unit ("0.6 m"), and a number with a decimal comma.
constexpr const char* expression = R"(^(?!\s*[0-9.]+\s*(?![eE][-+]?[0-9])[A-Za-z])(?![^(]*,))";
/// Also excludes an empty text.
constexpr const char* expression_with_a_value = R"(^(?=.*\S)(?!\s*[0-9.]+\s*(?![eE][-+]?[0-9])[A-Za-z])(?![^(]*,))";
constexpr const char* one_line = R"(^[^\u0000-\u001f\u007f]*$)";

Json number_of(const char* type, const Range& range) {
  Json number{{"type", {type, "string"}}, {"pattern", expression_with_a_value}};
  if (range.low == 0.0 && range.low_is_excluded) {
    number["minimum"] = smallest_number;
  } else if (std::isfinite(range.low)) {
    number[range.low_is_excluded ? "exclusiveMinimum" : "minimum"] = range.low;
  } else {
    number["minimum"] = -largest_number;
  }
  if (std::isfinite(range.high)) {
    number[range.high_is_excluded ? "exclusiveMaximum" : "maximum"] = range.high;
  } else {
    number["maximum"] = largest_number;
  }
  return number;
}

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

/// A vector of 2 or 3 dimensions; one rule for the whole file sets which.
Json vector_of(Json component) {
  Json vector = list_of(std::move(component));
  vector["minItems"] = 2;
  vector["maxItems"] = 3;
  return vector;
}

Json schema_of_type(const KeyInfo& key) {
  if (key.variables) {
    Json number{{"type", {"number", "string"}}, {"pattern", expression}};
    return key.type.starts_with("list") ? vector_of(std::move(number)) : number;
  }
  if (key.type == "number") return number_of("number", key.range);
  if (key.type == "whole number") {
    Range range = key.range;
    range.high = std::min<double>(range.high, std::numeric_limits<int>::max());
    return number_of("integer", range);
  }
  if (key.type == "choice") return {{"type", "string"}, {"enum", key.choices}};
  if (key.type == "vector") return vector_of(number_of("number", {}));
  if (key.type == "points") return list_of(vector_of(number_of("number", {})));
  if (key.type == "numbers") return list_of(number_of("number", {}));
  Json text{{"type", "string"}, {"pattern", one_line}};
  if (key.type == "text") return text;
  if (!key.choices.empty()) text["enum"] = key.choices;
  Json texts = list_of(text);
  texts["uniqueItems"] = true;
  return {{"anyOf", {std::move(text), std::move(texts)}}};
}

std::string tooltip(std::string_view table, const KeyInfo& key) {
  std::string text(key.doc);
  if (!key.unit.empty()) text += fmt::format(" [{}]", key.unit);
  if (key.type == "number" && !key.allowed.empty()) text += fmt::format("; {}", key.allowed);
  const std::string use = key_use_text(table, key.key);
  return use.empty() ? text : fmt::format("{}. Goes with {}", text, use);
}

/// The rule of one choice: the keys that it needs, and those that belong to other choices of its selector.
Json rule_of(const KeyUse& use, const TableInfo& table) {
  const auto info = std::ranges::find(table.keys, use.selector, &KeyInfo::key);
  Json rule{{"if", {{"properties", {{use.selector, {{"const", use.choice}}}}}}}};
  const bool is_default = info->presence == Presence::optional && info->value == toml_string(use.choice);
  if (!is_default) rule["if"]["required"] = Json::array({use.selector});
  Json then = Json::object();
  if (!use.needed.empty()) then["required"] = use.needed;
  for (const KeyInfo& key : table.keys) {
    if (use.needs(key.key) && key.type == "text") then["properties"][key.key] = {{"minLength", 1}};
    if (use.mentions(key.key)) continue;
    const bool is_of_another = std::ranges::any_of(key_uses(), [&](const KeyUse& other) {
      return other.table == use.table && other.selector == use.selector && other.mentions(key.key);
    });
    if (is_of_another) then["properties"][key.key] = false;
  }
  rule["then"] = std::move(then);
  return rule;
}

Json schema_of(const TableInfo& table) {
  Json schema{{"type", "object"}, {"description", table.doc}, {"additionalProperties", false}};
  std::vector<std::string_view> required;
  for (const KeyInfo& key : table.keys) {
    Json& property = schema["properties"][key.key] = schema_of_type(key);
    property["description"] = tooltip(table.name, key);
    if (key.presence == Presence::required) required.push_back(key.key);
  }
  if (!required.empty()) schema["required"] = required;
  Json rules = table_rules_of_schema(table.name);
  for (const KeyUse& use : key_uses()) {
    if (use.table == table.name) rules.push_back(rule_of(use, table));
  }
  if (!rules.empty()) schema["allOf"] = std::move(rules);
  if (!table.is_list) return schema;
  Json list = list_of(std::move(schema));
  list["description"] = table.doc;
  return list;
}

/// The rules for a file of that dimension, including the number of components of all vectors.
Json in_dimension(int count) {
  const Json length{{"minItems", count}, {"maxItems", count}};
  Json tables = dimension_rules_of_schema(count);
  for (const TableInfo& table : case_tables()) {
    for (const KeyInfo& key : table.keys) {
      const bool is_vector = key.type == "vector" || (key.variables && key.type.starts_with("list"));
      if (!is_vector && key.type != "points") continue;
      Json& rules = table.is_list ? tables[table.name]["items"] : tables[table.name];
      Json& rule = rules["properties"][key.key];
      (is_vector ? rule : rule["items"]).update(length);
    }
  }
  return {{"properties", std::move(tables)}};
}

/// Excludes the names of coordinates, the time, numbers and functions.
std::string parameter_name() {
  return fmt::format("^(?!(x|y|z|t|dx|g|pi|{})$)[A-Za-z_][A-Za-z0-9_]*$", fmt::join(function_names(), "|"));
}

Json dimension_is(int dimension) {
  return {{"properties", {{"case", {{"properties", {{"dimension", {{"const", dimension}}}}}}}}}};
}

}  // namespace

std::string case_schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", fmt::format("Case file of Tailwater, format {}", case_format)},
              {"type", "object"},
              {"additionalProperties", false},
              {"required", Json::array()}};
  schema["properties"]["parameters"] = {{"type", "object"},
                                        {"description", "Named numbers for use in expressions"},
                                        {"propertyNames", {{"pattern", parameter_name()}}},
                                        {"additionalProperties", number_of("number", {})}};
  for (const TableInfo& table : case_tables()) {
    const bool needs_a_key =
        std::ranges::any_of(table.keys, [](const KeyInfo& key) { return key.presence == Presence::required; });
    if (!table.is_list && needs_a_key) schema["required"].push_back(table.name);
    schema["properties"][table.name] = schema_of(table);
  }
  schema["properties"]["case"]["properties"]["format"]["maximum"] = case_format;
  Json in_space = dimension_is(3);
  in_space["required"] = Json::array({"case"});
  in_space["properties"]["case"]["required"] = Json::array({"dimension"});
  Json rules = file_rules_of_schema();
  rules.push_back({{"if", dimension_is(2)}, {"then", in_dimension(2)}});
  rules.push_back({{"if", std::move(in_space)}, {"then", in_dimension(3)}});
  schema["allOf"] = std::move(rules);
  return schema.dump(1) + "\n";
}

}  // namespace tailwater
