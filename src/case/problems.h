// The list of all problems of a case, so that its author can read them all at once.
#pragma once

#include <string>

#include <toml++/toml.h>

#include "base/finding.h"
#include "base/text.h"

namespace tailwater {

/// A value as in messages: TOML on one line, cut off if it is long.
std::string value_text(const toml::node& node);

/// The position in the file, or the override that the value came from; just the file if `source` is null or unknown.
FilePosition position_of(const std::string& file, const toml::source_region* source);

class Problems {
 public:
  explicit Problems(const std::string& file) : file_(printable(file)) {}

  /// `source` is the position in the file or in an override; null: the file as a whole.
  void add(MessageId id, const toml::source_region* source, const CaseLabel& about, const std::string& message);

  /// Adds "wall[0].points[1] = 3: MESSAGE" about a value; `part` names a part of the key, such as "points[1]".
  void wrong(MessageId id, const CaseLabel& key, const toml::node& node, const std::string& message,
             std::string_view part = "");

  /// An override whose key does not exist in the file.
  void add_override(MessageId id, const std::string& origin, const std::string& message);

  bool none() const { return findings_.empty(); }

  /// Problems of overrides come first, then those of the file from top to bottom, then missing keys.
  Findings findings() const;

 private:
  std::string file_;
  Findings findings_;
};

}  // namespace tailwater
