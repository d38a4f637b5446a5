// What a check found. Every message names the object, the value and the remedy.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace tailwater {

enum class Severity { warning, error };

struct Finding {
  Severity severity = Severity::error;
  std::string message;

  template <class... Arguments>
  static Finding error(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    return {Severity::error, fmt::format(text, std::forward<Arguments>(arguments)...)};
  }
  template <class... Arguments>
  static Finding warning(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    return {Severity::warning, fmt::format(text, std::forward<Arguments>(arguments)...)};
  }
};

using Findings = std::vector<Finding>;

inline bool has_error(const Findings& findings) {
  return std::ranges::any_of(findings, [](const Finding& finding) { return finding.severity == Severity::error; });
}

inline void append(Findings& all, const Findings& more) { all.insert(all.end(), more.begin(), more.end()); }

}  // namespace tailwater
