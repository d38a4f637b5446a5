// Information about a run from its folder, whether it is running or has ended.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/json.h"

namespace tailwater {

/// A line of a digest: "cost" and its text.
struct InfoLine {
  std::string label;
  std::string text;
};

/// The last whole line of a run's steps.csv by the names of its columns; empty if there is none.
std::map<std::string, double> last_step(const std::filesystem::path& run);

/// The summary that a run has left in its folder. Throws IoError.
Json read_summary(const std::filesystem::path& run);

/// The facts that a user needs before the numbers of a run are used. Throws Json::exception if the summary is not of
/// this version.
std::vector<InfoLine> summary_digest(const Json& summary);

/// The state of a run, for viewers: {state, time, end, progress, time_left, particles, lines, warnings, measurements,
/// controls} (docs/reference/view.md). Unreadable parts are left out: the content of the folder never causes an
/// exception.
Json run_info(const std::filesystem::path& run);

}  // namespace tailwater
