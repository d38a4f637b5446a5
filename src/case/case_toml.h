// The text of a case file, and its TOML tree.
#pragma once

#include <toml++/toml.h>

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

namespace tailwater {

/// bytes; a hundred times the size of usual cases, and read in an instant
inline constexpr std::uintmax_t largest_case_file = 1 << 18;

/// bytes; the case that a run writes has every key, with its explanation
inline constexpr std::uintmax_t largest_effective_case = 32 * largest_case_file;

/// Throws IoError if the file cannot be read, InputError if it has more than `largest` bytes.
std::string read_case_file(const std::filesystem::path& path, std::uintmax_t largest);

/// The text of a case on a stream, as from standard input. Throws InputError if it has no end.
std::string read_case_from(std::istream& stream);

/// Throws InputError with `file`, line and column where the text is not TOML.
toml::table parse_case(std::string_view text, const std::string& file);

}  // namespace tailwater
