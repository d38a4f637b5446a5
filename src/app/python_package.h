#pragma once

#include <string>
#include <vector>

namespace tailwater {

/// Becomes a Python module, as "tailwater_validation.validate" or "tailwater.study_command", of a package that is in
/// share/tailwater/validation or lib/python3/dist-packages of a folder above this program, so that signals and the exit
/// code are its own. It is told where this program is (`--program`). Throws IoError if it or Python is not there.
[[noreturn]] void become_python(const std::string& module, const std::vector<std::string>& options);

/// Runs such a program and waits for it. Throws IoError, with the last line of what it said, if it does not end with
/// exit code 0, and if it cannot be started.
void run_python(const std::string& module, const std::vector<std::string>& options);

}  // namespace tailwater
