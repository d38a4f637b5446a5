// Case files of formats before this program's, brought up to date.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

struct Migration {
  std::string text;
  std::vector<std::string> changes;  ///< one line each, with the line of the old file; none: the text is as it was
};

/// The text of a case file in the format of this program: a key that has another place or name today is moved there,
/// one that has no successor becomes a comment, and the format is written down. All else stays as it is, comments too.
/// Throws InputError, with `file`, where the text is not TOML, is of a newer format, or has such keys in an inline
/// table.
Migration migrate_case(std::string_view text, const std::string& file);

}  // namespace tailwater
