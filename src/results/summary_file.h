// The file summary.json of a run.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace tailwater {

/// Replaces the file as a whole if possible; on a disk that is too full for this, overwrites its bytes. Throws IoError.
void write_last_file(const std::filesystem::path& path, const std::string& text);

/// Changes a summary with the state "running" to failed, with the reason. For a rank that cannot make a summary any
/// more; not collective. Leaves the file unchanged if it cannot be written.
void mark_as_failed(const std::filesystem::path& summary, ExitCode code, const std::string& message);

/// The case file that a summary names; empty if there is no summary of a run.
std::filesystem::path case_named_in(const std::filesystem::path& summary);

/// The number of ranks in a summary; 1 if there is none.
int ranks_named_in(const std::filesystem::path& summary);

}  // namespace tailwater
