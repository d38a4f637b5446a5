#include "case/sources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.h"

namespace tailwater {

std::string_view CaseSources::place_of(std::string_view line) const {
  const Entry* first = nullptr;
  std::size_t where = std::string_view::npos;
  for (const Entry& entry : entries_) {
    const std::size_t found = line.find(entry.name);
    if (found == std::string_view::npos || found > where) continue;
    // "wall 'tank': points" begins where "wall 'tank'" does, and says more.
    if (first != nullptr && found == where && entry.name.size() < first->name.size()) continue;
    first = &entry;
    where = found;
  }
  return first == nullptr ? std::string_view() : std::string_view(first->place);
}

std::string CaseSources::placed(std::string_view message) const {
  std::vector<std::string> lines;
  for (const std::string_view line : split(message, '\n')) {
    const std::string_view place = place_of(line);
    lines.push_back(place.empty() ? std::string(line) : fmt::format("{}: {}", place, line));
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace tailwater
