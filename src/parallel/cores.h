// The cores that are available to a run of this program.
#pragma once

#include <filesystem>
#include <vector>

namespace tailwater {

/// Processors (threads of cores) on which the system lets this process run, by their numbers.
std::vector<int> usable_processors();

/// The number of separate cores among these processors, where two threads of one core count once. It is limited by the
/// processor time granted to the control group of this process (of a container, or of systemd); at least 1. `root` is
/// the folder that has the system's `sys` and `proc`.
int cores_of(const std::vector<int>& processors, const std::filesystem::path& root = "/");

}  // namespace tailwater
