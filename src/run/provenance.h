// Where a result comes from: program, commit, compiler, libraries, machine.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tailwater {

/// {"version", "commit", "compiler", "options", "libraries", "machine": {"name", "processor", "cores"}}
nlohmann::ordered_json provenance();

/// "tailwater 1.0.0 (commit abc123)"
std::string version_line();

}  // namespace tailwater
