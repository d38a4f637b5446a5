// zlib streams in memory.
#pragma once

#include <string>
#include <string_view>

namespace tailwater {

/// The bytes as one zlib stream. `level`: 1, quick, to 9, small. Throws std::bad_alloc.
std::string deflated(std::string_view raw, int level);

}  // namespace tailwater
