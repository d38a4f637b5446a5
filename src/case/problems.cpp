#include "case/problems.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "base/text.h"
#include "case/overrides.h"
#include "case/toml_text.h"

namespace tailwater {

namespace {

constexpr std::size_t longest = 60;  ///< letters of a value that are shown

std::string full_value_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return toml_string(text->get());
  if (const auto* number = node.as_integer()) {
    return fmt::format("{}", number->get());
  }
  if (const auto* number = node.as_floating_point()) {
    return fmt::format("{}", number->get());
  }
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* array = node.as_array()) {
    std::string text = "[";
    for (std::size_t i = 0; i < array->size() && text.size() <= longest; ++i) {
      text += fmt::format("{}{}", i > 0 ? ", " : "", full_value_text((*array)[i]));
    }
    return text + "]";
  }
  return node.is_table() ? "{...}" : "a date or time";
}

}  // namespace

std::string value_text(const toml::node& node) {
  const std::string text = full_value_text(node);
  std::size_t end = std::min(text.size(), longest);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
    --end;  // whole letters
  return end == text.size() ? text : fmt::format("{}...", text.substr(0, end));
}

std::string place_text(const std::string& file, const toml::source_region* source) {
  if (source == nullptr || !source->begin) return file;
  if (source->path && source->path->starts_with(override_prefix)) return *source->path;
  return fmt::format("{}:{}:{}", file, source->begin.line, source->begin.column);
}

void Problems::add(const toml::source_region* source, const std::string& message) {
  const std::string line = printable(fmt::format("{}: {}", place_text(file_, source), message));
  if (source == nullptr || !source->begin) {
    lines_.push_back({std::numeric_limits<unsigned>::max(), line});
  } else if (source->path && source->path->starts_with(override_prefix)) {
    add_override(line);
  } else {
    lines_.push_back({source->begin.line, line});
  }
}

void Problems::add_override(const std::string& line) { lines_.push_back({0, printable(line)}); }

std::string Problems::text() const {
  std::vector<Line> sorted = lines_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Line& a, const Line& b) { return a.number < b.number; });
  constexpr std::size_t most_shown = 50;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(sorted.size(), most_shown); ++i) texts.push_back(sorted[i].text);
  if (sorted.size() > most_shown) {
    texts.push_back(fmt::format("{}: and {} more problems", file_, sorted.size() - most_shown));
  }
  return fmt::format("{}", fmt::join(texts, "\n"));
}

}  // namespace tailwater
