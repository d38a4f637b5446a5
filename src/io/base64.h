// Encodes bytes as letters, for texts that must contain them (RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace tailwater {

std::string base64(std::string_view bytes);

}  // namespace tailwater
