// The documentation of the case file, made from the keys themselves.
#pragma once

#include <string>

namespace tailwater {

/// For `tailwater run --help-case`: every key with default, unit, range and meaning, as plain text.
std::string case_help();

/// For `tailwater run --help-case=markdown`: the same as a page, docs/reference/case-file.md.
std::string case_reference_markdown();

}  // namespace tailwater
