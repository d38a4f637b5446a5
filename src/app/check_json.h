// The output of `tailwater check --json`, for a case that is being written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"

namespace tailwater {

/// Whether the time of a run is estimated from a few trial steps, which take a second or some.
enum class TrialSteps { none, some };

/// The findings about the text of a case, its drawing and its size: {findings, drawing, summary, cost}
/// (docs/reference/view.md). `origin` is the name of the text in messages; files that it names are relative to
/// `folder`. Faults of the case are findings, not exceptions.
Json check_as_json(const std::string& text, const std::string& origin, const std::filesystem::path& folder,
                   const std::vector<std::string>& overrides, TrialSteps trial);

}  // namespace tailwater
