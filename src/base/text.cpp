#include "base/text.h"

#include <fmt/format.h>

namespace tailwater {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size(); begin += parts.back().size() + 1) {
    parts.push_back(text.substr(begin, text.find(separator, begin) - begin));
  }
  return parts;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines = split(text, '\n');
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

std::size_t size_of_letter(std::string_view text) {
  const auto byte = [text](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < size) return 0;
  for (std::size_t k = 1; k < size; ++k) {
    if ((byte(k) & 0xc0) != 0x80) return 0;
  }
  const bool is_too_long = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool is_surrogate = first == 0xed && byte(1) > 0x9f;
  const bool is_too_large = first == 0xf4 && byte(1) > 0x8f;
  return is_too_long || is_surrogate || is_too_large ? 0 : size;
}

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t size = size_of_letter(text);
    const auto first = static_cast<unsigned char>(text[0]);
    const bool is_control = (first < 0x20 && first != '\t') || first == 0x7f ||
                            (first == 0xc2 && size == 2 && static_cast<unsigned char>(text[1]) < 0xa0);
    const std::string_view letter = text.substr(0, size == 0 ? 1 : size);
    text.remove_prefix(letter.size());
    if (size > 0 && !is_control) {
      shown += letter;
      continue;
    }
    for (const char byte : letter) shown += fmt::format("\\x{:02X}", static_cast<unsigned char>(byte));
  }
  return shown;
}

bool is_printable(std::string_view text) { return printable(text) == text; }

std::string shortened(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  const auto is_inside_letter = [text](std::size_t k) { return (static_cast<unsigned char>(text[k]) & 0xc0) == 0x80; };
  std::size_t head = most * 2 / 3;
  std::size_t tail = text.size() - most / 3;
  while (head > 0 && is_inside_letter(head)) --head;
  while (tail < text.size() && is_inside_letter(tail)) ++tail;
  return fmt::format("{} [...] {}", text.substr(0, head), text.substr(tail));
}

}  // namespace tailwater
