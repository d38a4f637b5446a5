// From a case file to a validated CaseSpec.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "case/spec.h"

namespace tailwater {

/// Reads the case in a TOML file, with `--set` overrides (overrides.h) applied to it. Every value lies in its range,
/// belongs to the chosen shape or type, and points have `dimension` coordinates; names are given and unique.
///
/// Numbers may be expressions (expression.h) of [parameters], of `dx` = particles.spacing and of `g` = |gravity|.
/// Parameters, dx and g may use one another in any order.
///
/// Throws IoError if the file cannot be read, else CaseError with a finding for each problem: position, key, value, the
/// allowed values and the remedy.
CaseSpec read_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// Reads the case that a run has left in its folder, which may be longer than the original.
CaseSpec read_effective_case(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// Reads the text of a case file; `origin` is its name in messages. Files that it names are relative to `folder`, by
/// default the working folder.
CaseSpec read_case_text(std::string_view text, const std::string& origin,
                        const std::vector<std::string>& overrides = {}, const std::filesystem::path& folder = {});

}  // namespace tailwater
