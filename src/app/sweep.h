// Runs the members of a sweep, several at a time, as processes of this program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "run/requests.h"

namespace tailwater {

struct SweepOptions {
  std::filesystem::path out;
  int jobs = 1;              ///< number of members at a time
  std::optional<int> ranks;  ///< of each member
  WallTime wall_time;        ///< of the whole sweep
};

/// Makes the folder of the sweep, with the case of each member in a folder of its own, and runs the members that are
/// not done. If the folder is already that of a sweep with the same cases, continues it; the new sweep may have more
/// members. Throws InputError before anything is written; IoError. A failed member is reported, and the others
/// continue. Returns done, the exit code of the first member that failed, or interrupted.
ExitCode run_sweep(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                   const std::vector<std::string>& keys, const SweepOptions& options);

/// Continues the sweep in options.out, as run_sweep does.
ExitCode resume_sweep(const SweepOptions& options);

}  // namespace tailwater
