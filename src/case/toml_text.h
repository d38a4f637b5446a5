// Values as TOML text. The text reads back as the same value, bit for bit, in every locale.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tailwater {

/// A basic string: in quotes, with quotes, backslashes and control characters escaped.
std::string toml_string(std::string_view text);

/// The shortest floating-point number that reads back as `value`; always with a point or an exponent, so that it is
/// not an integer. `value` is finite.
std::string toml_float(double value);

std::string_view without_spaces(std::string_view text);

/// The parts between commas that stand outside brackets and quotes, without spaces around them.
std::vector<std::string> split_at_commas(std::string_view text);

/// The line (from 1) of the first key with too many dots: recursion over its tree would overflow. None in a sound file,
/// whose keys have one dot or two.
std::optional<std::size_t> line_of_deep_key(std::string_view toml);

}  // namespace tailwater
