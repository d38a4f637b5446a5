#include "case/overrides.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <optional>
#include <utility>
#include <variant>

#include "case/nearest_name.h"
#include "case/spec.h"
#include "case/toml_text.h"

namespace tailwater {

namespace {

constexpr std::string_view usage =
    "write --set table.key=value, for example scheme.courant=0.1, fluid[0].max=[1,2] or probe.NAME.interval=0.01";

/// No key of a case is deeper: list, number, key, number, number.
constexpr std::size_t max_steps = 8;

/// One step down the tree: a name in a table, or a name or number in a list.
using Step = std::variant<std::string, std::size_t>;

/// The reason why the key of an override does not exist.
struct Misplaced {
  std::string reason;
};

std::size_t parse_index(std::string_view digits) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc{} || end != digits.data() + digits.size()) {
    throw Misplaced{fmt::format("\"[{}]\" is not an index of a list; {}", digits, usage)};
  }
  return index;
}

/// "fluid[0].max" as the steps fluid, 0, max.
std::vector<Step> parse_path(std::string_view path) {
  std::vector<Step> steps;
  while (true) {
    const std::size_t dot = path.find('.');
    std::string_view segment = path.substr(0, dot);
    std::size_t bracket = segment.find('[');
    const std::string_view name = segment.substr(0, bracket);
    if (name.empty()) {
      throw Misplaced{fmt::format("a name is missing in the key; {}", usage)};
    }
    steps.emplace_back(std::string(name));
    if (steps.size() > max_steps) throw Misplaced{fmt::format("the key has too many parts; {}", usage)};
    while (bracket != std::string_view::npos) {
      segment.remove_prefix(bracket + 1);
      const std::size_t close = segment.find(']');
      if (close == std::string_view::npos) {
        throw Misplaced{fmt::format("a bracket is not closed in the key; {}", usage)};
      }
      steps.emplace_back(parse_index(segment.substr(0, close)));
      segment.remove_prefix(close + 1);
      if (!segment.empty() && segment.front() != '[') {
        throw Misplaced{fmt::format("\"{}\" follows a bracket in the key; {}", segment, usage)};
      }
      bracket = segment.empty() ? std::string_view::npos : 0;
    }
    if (dot == std::string_view::npos) return steps;
    path.remove_prefix(dot + 1);
  }
}

/// The tree `value = ...`; empty if the text is not one TOML value.
std::optional<toml::table> as_toml(std::string_view text, std::string_view origin) {
  try {
    toml::table table = toml::parse(fmt::format("value = {}", text), origin);
    if (table.size() == 1) return table;
  } catch (const toml::parse_error&) {
  }
  return std::nullopt;
}

/// A list whose words and expressions have no quotes, such as [-a*t, 0], with quotes.
std::string quoted_elements(std::string_view list) {
  std::vector<std::string> elements = split_at_commas(list.substr(1, list.size() - 2));
  for (std::string& element : elements) {
    if (!as_toml(element, "")) element = toml_string(element);
  }
  return fmt::format("[{}]", fmt::join(elements, ", "));
}

/// The tree `value = ...`; words and expressions that are not TOML become strings.
toml::table parse_value(std::string_view text, std::string_view origin) {
  if (line_of_deep_key(text)) throw Misplaced{fmt::format("the value is nested too deeply; {}", usage)};
  if (auto table = as_toml(text, origin)) return std::move(*table);  // copies lose their source
  const bool is_list = text.size() > 2 && text.front() == '[' && text.back() == ']';
  return toml::parse(fmt::format("value = {}", is_list ? quoted_elements(text) : toml_string(text)), origin);
}

/// The element of a list of tables that has, or by default gets, this name.
toml::node* find_named(toml::array& list, const std::string& list_name, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const toml::table* table = list[i].as_table();
    names.push_back(table == nullptr ? "" : (*table)["name"].value_or(default_name(list_name, i)));
    if (table != nullptr && names.back() == name) return &list[i];
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  throw Misplaced{fmt::format("there is no {} named \"{}\"; {}", list_name, name, unknown_name_hint(name, views))};
}

toml::node* find_element(toml::array& list, std::string_view list_name, std::size_t index) {
  if (index >= list.size()) {
    throw Misplaced{fmt::format("{} has {} entries, counted from 0; there is no [{}]", list_name, list.size(), index)};
  }
  return &list[index];
}

/// The node one step below `node`; a missing table is made.
toml::node* descend(toml::node* node, const Step& step, const std::string& above) {
  if (const auto* name = std::get_if<std::string>(&step)) {
    if (toml::array* list = node->as_array()) return find_named(*list, above, *name);
    if (toml::table* table = node->as_table()) {
      if (!table->contains(*name)) {
        table->insert(*name, toml::table{});
      }
      return table->get(*name);
    }
  } else if (toml::array* list = node->as_array()) {
    return find_element(*list, above, std::get<std::size_t>(step));
  }
  throw Misplaced{fmt::format("{} is not a {}; {}", above, step.index() == 0 ? "table" : "list", usage)};
}

/// An override cannot add a parameter: no expression of the case uses it, so the name is a typing error.
void require_parameter(const toml::table& parameters, std::string_view name) {
  if (parameters.contains(name)) return;
  std::vector<std::string_view> names;
  for (const auto& [key, value] : parameters) names.push_back(key.str());
  throw Misplaced{fmt::format("the case has no parameter \"{}\"; {}", name, unknown_name_hint(name, names))};
}

void put(toml::node* node, const Step& step, const std::string& above, toml::node&& value) {
  toml::table* table = node->as_table();
  toml::array* list = node->as_array();
  if (const auto* name = std::get_if<std::string>(&step); name != nullptr && table != nullptr) {
    if (above == "parameters") require_parameter(*table, *name);
    table->insert_or_assign(*name, std::move(value));
  } else if (const auto* index = std::get_if<std::size_t>(&step); index != nullptr && list != nullptr) {
    find_element(*list, above, *index);
    list->replace(list->cbegin() + static_cast<std::ptrdiff_t>(*index), std::move(value));
  } else if (list != nullptr) {
    throw Misplaced{fmt::format("{} is a list; {}", above, usage)};
  } else {
    throw Misplaced{fmt::format("{} is not a {}; {}", above, step.index() == 0 ? "table" : "list", usage)};
  }
}

void apply(toml::table& root, std::string_view text, const std::string& origin) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    throw Misplaced{std::string(usage)};
  }
  const std::vector<Step> steps = parse_path(text.substr(0, equals));
  toml::table value = parse_value(text.substr(equals + 1), origin);
  toml::node* node = &root;
  std::string above;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    node = descend(node, steps[i], above);
    above = std::holds_alternative<std::string>(steps[i]) ? std::get<std::string>(steps[i]) : above;
  }
  put(node, steps.back(), above, std::move(*value.get("value")));
}

}  // namespace

void apply_overrides(toml::table& root, const std::vector<std::string>& overrides, Problems& problems) {
  for (const std::string& text : overrides) {
    const std::string origin = fmt::format("{}{}", override_prefix, text);
    try {
      apply(root, text, origin);
    } catch (const Misplaced& misplaced) {
      problems.add_override("override-misplaced", origin, misplaced.reason);
    }
  }
}

}  // namespace tailwater
