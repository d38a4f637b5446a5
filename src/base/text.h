// Text from outside: its parts, and its form for a terminal or a file of results.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

/// The parts of a text between separators: one of a text without them.
std::vector<std::string_view> split(std::string_view text, char separator);

/// The lines of a text, whether or not the last one has an end.
std::vector<std::string_view> lines_of(std::string_view text);

/// The number of bytes of the letter at the begin of `text`, which is not empty; 0 if they are no UTF-8.
std::size_t size_of_letter(std::string_view text);

/// The text with \xNN for characters that a terminal would execute instead of showing (control characters, ends of
/// lines too, but no tabs) and for bytes that are no UTF-8.
std::string printable(std::string_view text);

/// Whether the text can be shown unchanged.
bool is_printable(std::string_view text);

/// The text with its middle left out if it is longer than `most` bytes; letters stay whole.
std::string shortened(std::string_view text, std::size_t most);

}  // namespace tailwater
