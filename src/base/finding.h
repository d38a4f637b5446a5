// Findings about a case as data: table and key, places in space, value and remedy. Messages, marks in pictures and JSON
// are made from the data; no code parses a message.
#pragma once

#include <fmt/format.h>

#include <array>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
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
  std::string text() const;
};

/// A place in space, m.
struct MarkedPlace {
  std::array<double, 3> x{};
  int dimension = 0;

  /// "(0.5, 1.25)": coordinates below a picometre are 0, so that round-off is not shown.
  std::string text() const;
};

/// A number with its unit; the format is that of the number.
struct Amount {
  double number;
  std::string unit;
};

/// The name by which docs/reference/messages.md lists a message: lower-case words with hyphens, written as a literal
/// where the message is made.
class MessageId {
 public:
  template <std::size_t Size>
  consteval MessageId(const char (&literal)[Size]) : text_(literal) {
    for (const char letter : text_) {
      if ((letter < 'a' || letter > 'z') && (letter < '0' || letter > '9') && letter != '-') throw "not an id";
    }
  }

  constexpr std::string_view text() const { return text_; }

 private:
  std::string_view text_;
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
  std::string text() const;
};

enum class Severity { warning, error };

struct Finding {
  Severity severity;
  std::string_view id;
  CaseLabel about;
  std::vector<MarkedPlace> places;
  std::optional<Amount> value;
  std::string problem;  ///< the problem, and why it matters if that is not obvious
  std::string remedy;   ///< an imperative; empty if the problem is the whole message
  FilePosition position;

  Finding(Severity the_severity, MessageId the_id, Clause the_problem, Clause the_remedy,
          FilePosition the_position = {})
      : severity(the_severity),
        id(the_id.text()),
        about(std::move(the_problem.about)),
        places(std::move(the_problem.places)),
        value(std::move(the_problem.value)),
        problem(std::move(the_problem.words)),
        remedy(std::move(the_remedy.words)),
        position(std::move(the_position)) {}
  static Finding error(MessageId id, Clause problem, Clause remedy) {
    return {Severity::error, id, std::move(problem), std::move(remedy)};
  }
  static Finding warning(MessageId id, Clause problem, Clause remedy) {
    return {Severity::warning, id, std::move(problem), std::move(remedy)};
  }

  /// The common shape of messages: the problem, why it matters, the remedy.
  std::string message() const { return remedy.empty() ? problem : problem + "; " + remedy; }
  /// The position in the case file if that is known, the message, and its id in brackets.
  std::string line() const;
};

using Findings = std::vector<Finding>;

bool has_error(const Findings& findings);

inline void append(Findings& all, const Findings& more) { all.insert(all.end(), more.begin(), more.end()); }

/// The findings, with equal findings about several tables merged into one that names all tables.
Findings merge_alike(const Findings& findings);

/// Errors of a case that stop the command. The text has one line per finding, and at most 50.
class CaseError : public InputError {
 public:
  explicit CaseError(Findings findings) : InputError(text_of(findings)), findings_(std::move(findings)) {}
  CaseError(MessageId id, Clause problem, Clause remedy, FilePosition position = {})
      : CaseError(Findings{{Severity::error, id, std::move(problem), std::move(remedy), std::move(position)}}) {}

  const Findings& findings() const { return findings_; }

 private:
  static std::string text_of(const Findings& findings);

  Findings findings_;
};

}  // namespace tailwater

template <class Part>
requires std::same_as<Part, tailwater::CaseLabel> || std::same_as<Part, tailwater::MarkedPlace> ||
    std::same_as<Part, tailwater::Clause>
struct fmt::formatter<Part> : fmt::formatter<fmt::string_view> {
  format_context::iterator format(const Part& part, format_context& context) const;
};

template <>
struct fmt::formatter<tailwater::Amount> : fmt::formatter<double> {
  format_context::iterator format(const tailwater::Amount& amount, format_context& context) const;
};
