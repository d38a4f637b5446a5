#include "case/problems.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "case/overrides.h"
#include "case/toml_text.h"

namespace tailwater {

namespace {

std::string full_value_text(const toml::node& node) {
  if (const auto* text = node.as_string()) {
    return toml_string(text->get());
  }
  if (const auto* number = node.as_integer()) {
    return fmt::format("{}", number->get());
  }
  if (const auto* number = node.as_floating_point()) {
    return fmt::format("{}", number->get());
  }
  if (const auto* flag = node.as_boolean()) {
    return flag->get() ? "true" : "false";
  }
  if (const auto* array = node.as_array()) {
    std::vector<std::string> elements;
    for (const toml::node& element : *array) {
      elements.push_back(full_value_text(element));
    }
    return fmt::format("[{}]", fmt::join(elements, ", "));
  }
  return node.is_table() ? "{...}" : "a date or time";
}

}  // namespace

std::string value_text(const toml::node& node) {
  constexpr std::size_t longest = 60;
  const std::string text = full_value_text(node);
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

void Problems::add(const toml::source_region* source, const std::string& message) {
  if (source == nullptr || !source->begin) {
    lines_.push_back({std::numeric_limits<unsigned>::max(), fmt::format("{}: {}", file_, message)});
  } else if (source->path && source->path->starts_with(override_prefix)) {
    add_override(fmt::format("{}: {}", *source->path, message));
  } else {
    lines_.push_back(
        {source->begin.line, fmt::format("{}:{}:{}: {}", file_, source->begin.line, source->begin.column, message)});
  }
}

void Problems::add_override(const std::string& line) { lines_.push_back({0, line}); }

std::string Problems::text() const {
  std::vector<Line> sorted = lines_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Line& a, const Line& b) { return a.number < b.number; });
  std::vector<std::string_view> texts;
  for (const Line& line : sorted) {
    texts.push_back(line.text);
  }
  return fmt::format("{}", fmt::join(texts, "\n"));
}

}  // namespace tailwater
