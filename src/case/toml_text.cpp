#include "case/toml_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace tailwater {
namespace {

/// The parser limits the nesting of lists and tables in braces, but not the dots of keys.
constexpr int max_dots = 8;

/// The position behind the string that begins at `start`; for a string without end, the end of the line or of the text.
std::size_t end_of_string(std::string_view toml, std::size_t start) {
  const char quote = toml[start];
  const std::string three(3, quote);
  const bool is_multiline = toml.substr(start, 3) == three;
  const std::size_t length = is_multiline ? 3 : 1;
  for (std::size_t i = start + length; i < toml.size(); ++i) {
    if (toml[i] == '\\' && quote == '"') {
      ++i;
    } else if (toml.substr(i, length) == std::string_view(three).substr(0, length)) {
      return i + length;
    } else if (toml[i] == '\n' && !is_multiline) {
      return i;
    }
  }
  return toml.size();
}

}  // namespace

std::string_view without_spaces(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  text.remove_prefix(begin);
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = '\0';
  for (const char c : text) {
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{' || c == '(') {
      ++depth;
    } else if (c == ']' || c == '}' || c == ')') {
      --depth;
    }
    if (c == ',' && depth <= 0 && quote == '\0') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  for (std::string& part : parts) part = without_spaces(part);
  return parts;
}

std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      quoted += fmt::format("\\{}", letter);
    } else if (code < 0x20 || code == 0x7f) {
      quoted += fmt::format("\\u{:04X}", code);
    } else {
      quoted += letter;
    }
  }
  quoted += '"';
  return quoted;
}

std::string toml_float(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::optional<std::size_t> line_of_deep_key(std::string_view toml) {
  constexpr std::string_view ends_of_keys = ",=[]{}\n";
  int dots = 0;
  for (std::size_t i = 0; i < toml.size();) {
    if (toml[i] == '#') {
      i = std::min(toml.find('\n', i), toml.size());
    } else if (toml[i] == '"' || toml[i] == '\'') {
      i = end_of_string(toml, i);
    } else {
      if (ends_of_keys.find(toml[i]) != std::string_view::npos) dots = 0;
      if (toml[i] == '.' && ++dots > max_dots) {
        return 1 +
               static_cast<std::size_t>(std::count(toml.begin(), toml.begin() + static_cast<std::ptrdiff_t>(i), '\n'));
      }
      ++i;
    }
  }
  return std::nullopt;
}

}  // namespace tailwater
