#include "base/finding.h"

#include <algorithm>
#include <cmath>

namespace tailwater {

std::string CaseLabel::text() const {
  const std::string head = !name.empty() ? fmt::format("{} '{}'", table, name)
                           : index       ? fmt::format("{}[{}]", table, *index)
                                         : table;
  if (key.empty()) return head;
  return fmt::format("{}{}{}", head, name.empty() ? "." : ": ", key);
}

std::string MarkedPlace::text() const {
  std::array<double, 3> shown = x;
  for (double& coordinate : shown) coordinate = std::abs(coordinate) < 1e-12 ? 0.0 : coordinate;
  return fmt::format("({:.6g})", fmt::join(shown.begin(), shown.begin() + dimension, ", "));
}

std::string FilePosition::text() const {
  return column > 0 ? fmt::format("{}:{}:{}", file, line, column) : line > 0 ? fmt::format("{}:{}", file, line) : file;
}

std::string Finding::line() const {
  const std::string text = fmt::format("{} [{}]", message(), id);
  return position.file.empty() ? text : fmt::format("{}: {}", position.text(), text);
}

bool has_error(const Findings& findings) {
  return std::ranges::any_of(findings, [](const Finding& finding) { return finding.severity == Severity::error; });
}

namespace {

/// All that a finding says, without its own table and places.
std::string text_without_places(const Finding& finding) {
  std::string text = fmt::format("{}|{}|{}|{}", finding.severity == Severity::error, finding.about.table,
                                 finding.problem, finding.remedy);
  std::vector<std::string> own{finding.about.with_key("").text()};
  for (const MarkedPlace& place : finding.places) own.push_back(place.text());
  for (const std::string& part : own) {
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos;) text.erase(at, part.size());
  }
  return text;
}

}  // namespace

Findings merge_alike(const Findings& findings) {
  Findings merged;
  std::vector<std::string> kept;
  std::vector<std::vector<std::string>> others;
  for (const Finding& finding : findings) {
    const std::string text = text_without_places(finding);
    const auto same = std::ranges::find(kept, text);
    if (same == kept.end() || finding.about.name.empty()) {
      merged.push_back(finding);
      kept.push_back(text);
      others.emplace_back();
      continue;
    }
    const auto first = static_cast<std::size_t>(same - kept.begin());
    others[first].push_back(finding.about.with_key("").text());
    merged[first].places.insert(merged[first].places.end(), finding.places.begin(), finding.places.end());
  }
  for (std::size_t n = 0; n < merged.size(); ++n) {
    if (!others[n].empty()) merged[n].problem += fmt::format(" (likewise {})", fmt::join(others[n], ", "));
  }
  return merged;
}

std::string CaseError::text_of(const Findings& findings) {
  constexpr std::size_t max_shown = 50;
  std::vector<std::string> lines;
  for (const Finding& finding : findings) {
    if (lines.size() < max_shown) lines.push_back(finding.line());
  }
  if (findings.size() > max_shown) {
    lines.back() += fmt::format(" (and {} more problems)", findings.size() - max_shown);
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace tailwater

template <class Part>
requires std::same_as<Part, tailwater::CaseLabel> || std::same_as<Part, tailwater::MarkedPlace> ||
    std::same_as<Part, tailwater::Clause>
        fmt::format_context::iterator fmt::formatter<Part>::format(const Part& part, format_context& context)
const { return formatter<string_view>::format(part.text(), context); }
template struct fmt::formatter<tailwater::CaseLabel>;
template struct fmt::formatter<tailwater::MarkedPlace>;
template struct fmt::formatter<tailwater::Clause>;

fmt::format_context::iterator fmt::formatter<tailwater::Amount>::format(const tailwater::Amount& amount,
                                                                        format_context& context) const {
  return fmt::format_to(formatter<double>::format(amount.number, context), " {}", amount.unit);
}
