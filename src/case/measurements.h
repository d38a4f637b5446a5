// What laboratories have measured, from the files that the case names.
#pragma once

#include <toml++/toml.h>

#include "case/problems.h"
#include "case/spec.h"

namespace tailwater {

/// Reads the file of each measurement, and gives those their default column that name none. Reports what does not fit
/// their probes.
void read_measurements(CaseSpec& spec, const toml::table& root, Problems& problems);

}  // namespace tailwater
