// The page in the program.
#pragma once

#include <string_view>

namespace tailwater {

/// The page, as it is compiled in.
std::string_view view_page();

}  // namespace tailwater
