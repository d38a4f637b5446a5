// The cores that a run of this program may have.
#pragma once

#include <filesystem>
#include <vector>

namespace tailwater {

/// Processors (threads of cores) on which the system lets this process run, by their numbers.
std::vector<int> usable_processors();

/// How many of these processors are cores of their own, two threads of one counting once, as far as the time goes that
/// the control group of this process is granted (of a container, or of systemd); at least 1. `root` is the folder that
/// has the system's `sys` and `proc`.
int cores_of(const std::vector<int>& processors, const std::filesystem::path& root = "/");

}  // namespace tailwater
