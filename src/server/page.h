// The page that is compiled into the program.
#pragma once

#include <string_view>

namespace tailwater {

/// The page as a text.
std::string_view view_page();

}  // namespace tailwater
