// What `tailwater check --json` tells: of a case while somebody writes it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"

namespace tailwater {

/// Whether the time of a run is estimated, by a few steps of it, which take a second or some.
enum class TrialSteps { none, some };

/// What is wrong with the text of a case, what it looks like, and how large it is: {findings, drawing, summary, cost}
/// (docs/reference/view.md). `origin` is what messages call the text; files that it names are relative to `folder`.
/// Throws only what is not the fault of the case.
Json check_as_json(const std::string& text, const std::string& origin, const std::filesystem::path& folder,
                   const std::vector<std::string>& overrides, TrialSteps trial);

}  // namespace tailwater
