// Updates case files of earlier formats.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

struct Migration {
  std::string text;
  std::vector<std::string> changes;  ///< one line each, with the line of the old file; empty: the text is unchanged
};

/// Converts the text of a case file to the format of this program. A key that has another place or name today is moved
/// there, a key without successor becomes a comment, and the format is added. Everything else stays unchanged, comments
/// too. Throws InputError, with `file`, where the text is not TOML, has a newer format, or has such keys in an inline
/// table.
Migration migrate_case(std::string_view text, const std::string& file);

}  // namespace tailwater
