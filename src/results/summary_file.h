// The file summary.json of a run.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace tailwater {

/// Replaces the file as a whole, as always; where the disk is so full that this cannot be, writes over its bytes.
/// Throws IoError.
void write_last_file(const std::filesystem::path& path, const std::string& text);

/// Lets a summary that says "running" say that the run has failed, and why. For a rank that has nothing left to make a
/// summary of; not collective. What cannot be written stays as it is.
void mark_as_failed(const std::filesystem::path& summary, ExitCode code, const std::string& message);

/// The case file that a summary names; empty if there is no summary of a run.
std::filesystem::path case_named_in(const std::filesystem::path& summary);

/// The number of ranks that a summary tells; 1 if there is none to tell.
int ranks_named_in(const std::filesystem::path& summary);

}  // namespace tailwater
