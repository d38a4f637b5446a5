#include "case/problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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

FilePosition position_of(const std::string& file, const toml::source_region* source) {
  if (source == nullptr || !source->begin) return {file};
  if (source->path && source->path->starts_with(override_prefix)) return {*source->path};
  const auto& [begin, end, path] = *source;
  const auto end_column = begin.line == end.line ? end.column : 0;
  return {file, static_cast<int>(begin.line), static_cast<int>(begin.column), static_cast<int>(end_column)};
}

void Problems::add(MessageId id, const toml::source_region* source, const CaseLabel& about,
                   const std::string& message) {
  findings_.emplace_back(Severity::error, id, Clause("{}", printable(message)), Clause(), position_of(file_, source));
  findings_.back().about = about;
}

void Problems::wrong(MessageId id, const CaseLabel& key, const toml::node& node, const std::string& message,
                     std::string_view part) {
  const CaseLabel shown = part.empty() ? key : key.with_key(part);
  add(id, &node.source(), key, fmt::format("{} = {}: {}", shown, value_text(node), message));
}

void Problems::add_override(MessageId id, const std::string& origin, const std::string& message) {
  findings_.emplace_back(Severity::error, id, Clause("{}", printable(message)), Clause(),
                         FilePosition{printable(origin)});
}

Findings Problems::findings() const {
  const auto order = [&](const Finding& finding) {
    const FilePosition& at = finding.position;
    return at.line > 0 ? at.line : at.file == file_ ? std::numeric_limits<int>::max() : 0;
  };
  Findings sorted = findings_;
  std::ranges::stable_sort(sorted, {}, order);
  return sorted;
}

}  // namespace tailwater
