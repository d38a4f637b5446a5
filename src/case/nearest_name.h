// The hint for an unknown name: the most similar valid name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tailwater {

/// Edits that turn `a` into `b`: insertions, deletions, replacements and swaps of neighbours (optimal string alignment
/// distance). Upper and lower case count as equal.
int edit_distance(std::string_view a, std::string_view b);

/// The valid name nearest to `given`, if it is near enough for a typing error. That is at most one edit per three
/// letters of `given`, one in shorter names, and none in single letters (except upper for lower case).
std::optional<std::string_view> nearest_name(std::string_view given, std::span<const std::string_view> valid);

/// The names in quotes, separated by commas.
std::string quoted_list(std::span<const std::string_view> names);

/// The remedy for an unknown name: `did you mean "implicit"? valid: "explicit", "implicit"`; the question only if a
/// valid name is near.
std::string unknown_name_hint(std::string_view given, std::span<const std::string_view> valid);

}  // namespace tailwater
