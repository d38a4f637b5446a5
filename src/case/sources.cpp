#include "case/sources.h"

namespace tailwater {

void CaseSources::add(const CaseLabel& label, FilePosition position, int last_line) {
  entries_[{label.table, label.name, label.key}] = {label.index, std::move(position), last_line};
}

const CaseSources::Entry* CaseSources::find(const CaseLabel& label) const {
  const auto entry = entries_.find({label.table, label.name, label.key});
  return entry == entries_.end() ? nullptr : &entry->second;
}

Findings CaseSources::located(Findings findings) const {
  for (Finding& finding : findings) {
    const Entry* entry = find(finding.about);
    if (entry == nullptr) entry = find(finding.about.with_key(""));
    if (entry == nullptr) continue;
    finding.position = entry->position;
    finding.about.index = entry->index;
  }
  return findings;
}

std::optional<std::array<int, 2>> CaseSources::lines(const CaseLabel& table) const {
  const Entry* entry = find(table);
  if (entry == nullptr || entry->position.line == 0) return std::nullopt;
  return std::array{entry->position.line, entry->last_line};
}

}  // namespace tailwater
