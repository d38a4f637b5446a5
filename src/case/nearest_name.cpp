#include "case/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace tailwater {

namespace {

/// No name of a case file has more letters; comparing such names would take long.
constexpr std::size_t longest_name = 100;
constexpr std::size_t max_listed = 100;

char lower(char letter) { return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter; }

}  // namespace

int edit_distance(std::string_view a, std::string_view b) {
  // Row i holds the distances between the first i letters of a and every beginning of b.
  std::vector<int> row_before_last(b.size() + 1);
  std::vector<int> last_row(b.size() + 1);
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::swap(row_before_last, last_row);
    std::swap(last_row, row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool is_equal = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last_row[j] + 1, row[j - 1] + 1, last_row[j - 1] + (is_equal ? 0 : 1)});
      const bool is_swap = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (is_swap) row[j] = std::min(row[j], row_before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::optional<std::string_view> nearest_name(std::string_view given, std::span<const std::string_view> valid) {
  std::optional<std::string_view> nearest;
  if (given.size() > longest_name) return nearest;
  const int length = static_cast<int>(given.size());
  int least = (length < 2 ? 0 : std::max(1, length / 3)) + 1;
  for (const std::string_view name : valid) {
    if (name.size() > longest_name) continue;
    const int distance = edit_distance(given, name);
    if (distance < least) {
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

std::string quoted_list(std::span<const std::string_view> names) {
  std::string list;
  for (const std::string_view name : names.first(std::min(names.size(), max_listed))) {
    list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", name.substr(0, longest_name));
  }
  if (names.size() > max_listed) list += fmt::format(" and {} more", names.size() - max_listed);
  return list;
}

std::string unknown_name_hint(std::string_view given, std::span<const std::string_view> valid) {
  if (valid.empty()) return "there is none that could be named: add one, or remove this";
  const auto nearest = nearest_name(given, valid);
  return fmt::format("{}valid: {}", nearest ? fmt::format("did you mean \"{}\"? ", *nearest) : "", quoted_list(valid));
}

}  // namespace tailwater
