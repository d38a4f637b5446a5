#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "case/expression.h"
#include "case/key_info.h"
#include "case/key_use.h"
#include "case_help/help.h"

namespace tailwater {
namespace {

Json value_of(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return number->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  Json list = Json::array();
  if (const auto* array = node.as_array()) {
    for (const toml::node& element : *array) list.push_back(value_of(element));
  }
  return list;
}

/// null where there is none.
Json default_of(const KeyInfo& key) {
  if (key.presence == Presence::required || key.value == "[]" || key.value == "\"\"") return nullptr;
  const toml::table parsed = toml::parse("value = " + key.value);
  return value_of(*parsed.get("value"));
}

std::string_view type_of(const KeyInfo& key) {
  if (key.variables) return key.type.starts_with("list") ? "varying vector" : "varying number";
  return key.type;
}

void add_range(const Range& range, Json& key) {
  if (std::isfinite(range.low)) {
    key["minimum"] = range.low;
    key["minimum_is_excluded"] = range.low_is_excluded;
  }
  if (std::isfinite(range.high)) {
    key["maximum"] = range.high;
    key["maximum_is_excluded"] = range.high_is_excluded;
  }
}

/// The choices of another key of its table with which a key is allowed; null if all.
Json uses_of(std::string_view table, std::string_view key) {
  Json uses;
  for (const KeyUse& use : key_uses()) {
    const auto is_in = [key](const std::vector<std::string_view>& keys) {
      return std::ranges::find(keys, key) != keys.end();
    };
    if (use.table != table || (!is_in(use.needed) && !is_in(use.possible))) continue;
    uses["key"] = use.selector;
    uses["choices"].push_back(use.choice);
    if (is_in(use.needed)) uses["needed_by"].push_back(use.choice);
  }
  return uses;
}

Json description_of(std::string_view table, const KeyInfo& info) {
  Json key{{"name", info.key},
           {"type", type_of(info)},
           {"unit", info.unit},
           {"required", info.presence == Presence::required},
           {"default", default_of(info)}};
  add_range(info.range, key);
  if (!info.choices.empty()) key["choices"] = info.choices;
  if (info.variables) key["variables"] = names_of(*info.variables);
  if (Json uses = uses_of(table, info.key); !uses.is_null()) key["goes_with"] = std::move(uses);
  key["documentation"] = info.doc;
  return key;
}

}  // namespace

std::string case_reference_json() {
  Json reference{{"format", 1}, {"functions", function_names()}, {"tables", Json::array()}};
  reference["tables"].push_back({{"name", "parameters"},
                                 {"is_list", false},
                                 {"has_free_keys", true},
                                 {"documentation", "Named numbers for use in expressions"},
                                 {"keys", Json::array()}});
  for (const TableInfo& info : case_tables()) {
    Json table{{"name", info.name},
               {"is_list", info.is_list},
               {"has_free_keys", false},
               {"documentation", info.doc},
               {"keys", Json::array()}};
    for (const KeyInfo& key : info.keys) {
      if (key.presence != Presence::written) table["keys"].push_back(description_of(info.name, key));
    }
    reference["tables"].push_back(std::move(table));
  }
  return reference.dump(1) + "\n";
}

}  // namespace tailwater
