#include "io/base64.h"

#include <algorithm>
#include <cstdint>

namespace tailwater {

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
    std::uint32_t word = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      word = (word << 8U) | (b < count ? static_cast<std::uint8_t>(bytes[k + b]) : 0U);
    }
    for (std::size_t c = 0; c < 4; ++c) text += c <= count ? letters[(word >> (18U - 6U * c)) & 63U] : '=';
  }
  return text;
}

}  // namespace tailwater
