// Findings about a case as data: table and key, places in space, value and remedy. Messages, marks in pictures and JSON
// are made from the data; no code parses a message.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"

namespace tailwater {

/// A table of the case file, or a key in it.
struct CaseLabel {
  std::string table;
  std::string name;          ///< name of a table in a list; empty: unknown, or not in a list
  std::optional<int> index;  ///< index of a table in a list, from 0; empty: unknown, or not in a list
  std::string key;           ///< empty: the table as a whole

  CaseLabel() = default;
  explicit CaseLabel(std::string the_table, std::string the_name = "")
      : table(std::move(the_table)), name(std::move(the_name)) {}
  CaseLabel(std::string the_table, std::size_t the_index)
      : table(std::move(the_table)), index(static_cast<int>(the_index)) {}

  CaseLabel with_key(std::string_view the_key) const {
    CaseLabel label = *this;
    label.key = the_key;
    return label;
  }

  /// "wall 'bed'", "wall 'bed': points"; without a name "wall[0].points", "particles.spacing".
  std::string text() const {
    const std::string head = !name.empty() ? fmt::format("{} '{}'", table, name)
                             : index       ? fmt::format("{}[{}]", table, *index)
                                           : table;
    if (key.empty()) return head;
    return fmt::format("{}{}{}", head, name.empty() ? "." : ": ", key);
  }
};

/// A place in space, m.
struct MarkedPlace {
  std::array<double, 3> x{};
  int dimension = 0;

  /// "(0.5, 1.25)": coordinates below a picometre are 0, so that round-off is not shown.
  std::string text() const {
    std::array<double, 3> shown = x;
    for (double& coordinate : shown) coordinate = std::abs(coordinate) < 1e-12 ? 0.0 : coordinate;
    return fmt::format("({:.6g})", fmt::join(shown.begin(), shown.begin() + dimension, ", "));
  }
};

/// A number with its unit; the format is that of the number.
struct Amount {
  double number;
  std::string unit;
};

/// A part of a message, and the data among its arguments.
struct Clause {
  std::string words;
  CaseLabel about;                  ///< the first label
  std::vector<MarkedPlace> places;  ///< all of them
  std::optional<Amount> value;      ///< the first value

  Clause() = default;
  template <class... Arguments>
  Clause(fmt::format_string<Arguments...> format, Arguments&&... arguments)
      : words(fmt::vformat(format, fmt::make_format_args(arguments...))) {
    (take(arguments), ...);
  }

  const std::string& text() const { return words; }

 private:
  template <class Other>
  void take(const Other&) {}
  void take(const CaseLabel& label) {
    if (about.table.empty()) about = label;
  }
  void take(const MarkedPlace& place) { places.push_back(place); }
  void take(const Amount& amount) {
    if (!value) value = amount;
  }
  void take(const Clause& part) {
    take(part.about);
    places.insert(places.end(), part.places.begin(), part.places.end());
    if (!value) value = part.value;
  }
};

/// A position in the case file, or an override of the command line. Lines and columns count from 1; 0: unknown.
struct FilePosition {
  std::string file = {};
  int line = 0;
  int column = 0;
  int end_column = 0;  ///< behind the value

  /// "case.toml:12:1", or the known part of it.
  std::string text() const {
    return column > 0 ? fmt::format("{}:{}:{}", file, line, column)
           : line > 0 ? fmt::format("{}:{}", file, line)
                      : file;
  }
};

enum class Severity { warning, error };

struct Finding {
  Severity severity;
  CaseLabel about;
  std::vector<MarkedPlace> places;
  std::optional<Amount> value;
  std::string problem;  ///< the problem, and why it matters if that is not obvious
  std::string remedy;   ///< an imperative; empty if the problem is the whole message
  FilePosition position;

  Finding(Severity the_severity, Clause the_problem, Clause the_remedy, FilePosition the_position = {})
      : severity(the_severity),
        about(std::move(the_problem.about)),
        places(std::move(the_problem.places)),
        value(std::move(the_problem.value)),
        problem(std::move(the_problem.words)),
        remedy(std::move(the_remedy.words)),
        position(std::move(the_position)) {}
  static Finding error(Clause problem, Clause remedy) {
    return {Severity::error, std::move(problem), std::move(remedy)};
  }
  static Finding warning(Clause problem, Clause remedy) {
    return {Severity::warning, std::move(problem), std::move(remedy)};
  }

  /// The common shape of messages: the problem, why it matters, the remedy.
  std::string message() const { return remedy.empty() ? problem : problem + "; " + remedy; }
  /// The message, behind the position in the case file if that is known.
  std::string line() const {
    return position.file.empty() ? message() : fmt::format("{}: {}", position.text(), message());
  }
};

using Findings = std::vector<Finding>;

inline bool has_error(const Findings& findings) {
  return std::ranges::any_of(findings, [](const Finding& finding) { return finding.severity == Severity::error; });
}

inline void append(Findings& all, const Findings& more) { all.insert(all.end(), more.begin(), more.end()); }

/// The findings, with equal findings about several tables merged into one that names all tables.
inline Findings merge_alike(const Findings& findings) {
  const auto blanked = [](const Finding& finding) {
    std::string text = fmt::format("{}|{}|{}|{}", finding.severity == Severity::error, finding.about.table,
                                   finding.problem, finding.remedy);
    std::vector<std::string> own{finding.about.with_key("").text()};
    for (const MarkedPlace& place : finding.places) own.push_back(place.text());
    for (const std::string& part : own) {
      for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos;) text.erase(at, part.size());
    }
    return text;
  };
  Findings merged;
  std::vector<std::string> kept;
  std::vector<std::vector<std::string>> others;
  for (const Finding& finding : findings) {
    const std::string text = blanked(finding);
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

/// Errors of a case that stop the command. The text has one line per finding, and at most 50.
class CaseError : public InputError {
 public:
  explicit CaseError(Findings findings) : InputError(text_of(findings)), findings_(std::move(findings)) {}
  CaseError(Clause problem, Clause remedy, FilePosition position = {})
      : CaseError(Findings{{Severity::error, std::move(problem), std::move(remedy), std::move(position)}}) {}

  const Findings& findings() const { return findings_; }

 private:
  static std::string text_of(const Findings& findings) {
    constexpr std::size_t most_shown = 50;
    std::vector<std::string> lines;
    for (const Finding& finding : findings) {
      if (lines.size() < most_shown) lines.push_back(finding.line());
    }
    if (findings.size() > most_shown) {
      lines.back() += fmt::format(" (and {} more problems)", findings.size() - most_shown);
    }
    return fmt::format("{}", fmt::join(lines, "\n"));
  }

  Findings findings_;
};

}  // namespace tailwater

template <class Part>
requires std::same_as<Part, tailwater::CaseLabel> || std::same_as<Part, tailwater::MarkedPlace> ||
    std::same_as<Part, tailwater::Clause>
struct fmt::formatter<Part> : fmt::formatter<std::string> {
  auto format(const Part& part, fmt::format_context& context) const {
    return fmt::formatter<std::string>::format(part.text(), context);
  }
};

template <>
struct fmt::formatter<tailwater::Amount> : fmt::formatter<double> {
  auto format(const tailwater::Amount& amount, fmt::format_context& context) const {
    return fmt::format_to(fmt::formatter<double>::format(amount.number, context), " {}", amount.unit);
  }
};
