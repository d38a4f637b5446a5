#include "app/case_text.h"

#include <algorithm>
#include <cctype>

namespace tailwater {
namespace {

/// Takes the first line, without its end, off a text.
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

std::string_view without_indent(std::string_view line) {
  while (!line.empty() && std::isspace(static_cast<unsigned char>(line.front())) != 0) line.remove_prefix(1);
  return line;
}

/// Of tables and keys.
bool is_of_name(char c) { return c == '_' || (c >= 'a' && c <= 'z'); }

/// "wall" if a line is the heading of such a table, [wall] or [[wall]]; else nothing. Values in brackets that begin a
/// line are none.
std::string table_in(std::string_view line) {
  line = without_indent(line);
  const std::size_t brackets = line.starts_with("[[") ? 2 : line.starts_with("[") ? 1 : 0;
  if (brackets == 0) return "";
  const std::size_t end = line.find(']');
  if (end == line.npos) return "";
  const std::string_view name = line.substr(brackets, end - brackets);
  return !name.empty() && std::ranges::all_of(name, is_of_name) ? std::string(name) : "";
}

/// "spacing" if a line is that of such a key; else nothing.
std::string key_in(std::string_view line) {
  line = without_indent(line);
  const auto is_of_key = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  };
  const auto* end = std::ranges::find_if_not(line, is_of_key);
  const std::string_view name = line.substr(0, static_cast<std::size_t>(end - line.begin()));
  return without_indent(line.substr(name.size())).starts_with('=') ? std::string(name) : "";
}

}  // namespace

std::map<std::string, std::vector<std::pair<int, int>>> lines_of_tables(std::string_view text) {
  std::map<std::string, std::vector<std::pair<int, int>>> tables;
  std::pair<int, int>* open = nullptr;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    const std::string table = table_in(line);
    if (!table.empty()) open = &tables[table].emplace_back(number, number);
    const std::string_view words = without_indent(line);
    const bool is_blank = words.empty() || words.starts_with('#');
    if (open != nullptr && !is_blank) open->second = number;
  }
  return tables;
}

std::string key_at(std::string_view text, int line) {
  std::string table;
  std::string key;
  for (int number = 1; number <= line && !text.empty(); ++number) {
    const std::string_view here = take_line(text);
    if (const std::string heading = table_in(here); !heading.empty()) {
      table = heading;
      key.clear();
    } else if (const std::string name = key_in(here); !name.empty()) {
      key = name;
    }
  }
  return table.empty() || key.empty() ? table + key : table + "." + key;
}

int end_column(std::string_view text, int line, int column) {
  std::string_view here;
  for (int number = 1; number <= line; ++number) here = take_line(text);
  const auto begin = static_cast<std::size_t>(std::max(1, column) - 1);
  char quote = '\0';
  int depth = 0;
  for (std::size_t k = begin; k < here.size(); ++k) {
    const char c = here[k];
    if (quote != '\0') {
      if (c == '\\' && quote == '"') {
        ++k;
      } else if (c == quote) {
        quote = '\0';
      }
      if (quote == '\0' && depth == 0) return static_cast<int>(k) + 2;
      continue;
    }
    if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      if (depth == 0) return static_cast<int>(k) + 1;
      if (--depth == 0 && (k + 1 == here.size() || here[k + 1] != ']')) return static_cast<int>(k) + 2;
    } else if (depth == 0 && k > begin && (c == ' ' || c == '\t' || c == ',' || c == '#' || c == '=')) {
      return static_cast<int>(k) + 1;
    }
  }
  return static_cast<int>(here.size()) + 1;
}

}  // namespace tailwater
