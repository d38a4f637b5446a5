// The parts of a case that all keys depend on: its format, its dimension, and the named numbers of its expressions.
#pragma once

#include <toml++/toml.h>

#include "case/spec.h"
#include "case/table_reader.h"

namespace tailwater {

/// Reads case.format, case.dimension, [parameters], particles.spacing and physics.gravity into `spec`, and the
/// dimension and the named numbers into `context`. Parameters, dx and g may use one another in any order. Throws
/// CaseError for a format of a newer program.
void read_foundations(CaseSpec& spec, Context& context, const toml::table& root);

}  // namespace tailwater
