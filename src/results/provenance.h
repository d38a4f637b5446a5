// The origin of a result: program, commit, compiler, libraries, machine.
#pragma once

#include <string>

#include "base/json.h"

namespace tailwater {

/// {"version", "commit", "compiler", "options", "libraries", "machine": {"name", "processor", "cores"}}
Json provenance();

/// "tailwater 1.0.0 (commit abc123)"
std::string version_line();

}  // namespace tailwater
