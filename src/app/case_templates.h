// The templates of `tailwater new`.
#pragma once

#include <map>
#include <string>

namespace tailwater {

/// Texts of cases by name.
const std::map<std::string, const char*>& case_templates();

}  // namespace tailwater
