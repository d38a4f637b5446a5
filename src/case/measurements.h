// Measurements of laboratories, from the files that the case names.
#pragma once

#include <toml++/toml.h>

#include "case/problems.h"
#include "case/spec.h"

namespace tailwater {

/// Reads the file of each measurement, and sets the default column of those that name none. Reports contradictions with
/// their probes.
void read_measurements(CaseSpec& spec, const toml::table& root, Problems& problems);

}  // namespace tailwater
