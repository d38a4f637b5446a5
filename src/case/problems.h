// The list of all problems of a case, so that its author can read them all at once.
#pragma once

#include <string>
#include <vector>

#include <toml++/toml.h>

namespace tailwater {

/// A value as messages show it: TOML on one line, cut off if it is long.
std::string value_text(const toml::node& node);

/// "case.toml:12:1", or the override that the value came from; just the file if `source` is null or unknown.
std::string place_text(const std::string& file, const toml::source_region* source);

class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  /// `source` is where the thing is, in the file or in an override; null: the file as a whole.
  void add(const toml::source_region* source, const std::string& message);

  /// A complete line about an override whose key does not exist in the file.
  void add_override(const std::string& line);

  bool none() const { return lines_.empty(); }

  /// One line per problem: overrides, then the file from top to bottom, then what is missing.
  std::string text() const;

 private:
  struct Line {
    unsigned number;  ///< in the file
    std::string text;
  };

  std::string file_;
  std::vector<Line> lines_;
};

}  // namespace tailwater
