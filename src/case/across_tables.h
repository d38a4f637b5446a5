// Rules that involve several tables of a case.
#pragma once

#include <toml++/toml.h>

#include "case/problems.h"
#include "case/spec.h"

namespace tailwater {

/// Reports walls that bodies and zones name and that do not exist, or that no body can have. Tables may have problems
/// of their own.
void check_named_walls(const CaseSpec& spec, const toml::table& root, Problems& problems);

/// Reports other contradictions between tables of the case `spec`, which was read from `root`, once each table is
/// sound.
void check_across_tables(const CaseSpec& spec, const toml::table& root, Problems& problems);

/// Reports series of walls and gates that end before the run.
void check_ends_of_series(const CaseSpec& spec, const toml::table& root, Problems& problems);

}  // namespace tailwater
