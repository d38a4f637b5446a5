#pragma once

#include <string>
#include <vector>

namespace tailwater {

/// Replaces this process by a Python module, as "tailwater_validation.validate" or "tailwater.study_command", so that
/// signals and the exit code are those of the module. Its package is in share/tailwater/validation or
/// lib/python3/dist-packages of a folder above this program. The module gets the path of this program (`--program`).
/// Throws IoError if the module or Python is missing.
[[noreturn]] void become_python(const std::string& module, const std::vector<std::string>& options);

/// Runs such a program and waits for it. Throws IoError, with the last line of its output, if it does not end with exit
/// code 0, and if it cannot be started.
void run_python(const std::string& module, const std::vector<std::string>& options);

}  // namespace tailwater
