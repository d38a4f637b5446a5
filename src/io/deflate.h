// zlib streams in memory.
#pragma once

#include <string>
#include <string_view>

namespace tailwater {

/// The bytes as one zlib stream; equal bytes give equal streams. `level`: from 1, quick, to 12, small. Throws
/// std::bad_alloc.
std::string deflated(std::string_view raw, int level);

}  // namespace tailwater
