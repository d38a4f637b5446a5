// Rules that involve several tables of a case, checked once each table is sound.
#pragma once

#include <toml++/toml.h>

#include "case/problems.h"
#include "case/spec.h"

namespace tailwater {

/// Reports contradictions between tables of the case `spec`, which was read from `root`.
void check_across_tables(const CaseSpec& spec, const toml::table& root, Problems& problems);

}  // namespace tailwater
