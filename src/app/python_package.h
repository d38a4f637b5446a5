#pragma once

#include <string>
#include <vector>

namespace tailwater {

/// Becomes a program of the Python package in share/tailwater/validation of a folder above this program, so that
/// signals and the exit code are its own. The package's program is told where this one is (`--program`). Throws IoError
/// if the package or Python is not there.
[[noreturn]] void become_python(const std::string& module, const std::vector<std::string>& options);

/// Runs such a program and waits for it. Throws IoError, with the last line of what it said, if it does not end with
/// exit code 0, and if it cannot be started.
void run_python(const std::string& module, const std::vector<std::string>& options);

}  // namespace tailwater
