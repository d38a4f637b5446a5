// What all keys of a case depend on: its format and dimension, and the numbers that its expressions may use by name.
#pragma once

#include <toml++/toml.h>

#include "case/spec.h"
#include "case/table_reader.h"

namespace tailwater {

/// Reads case.format, case.dimension, [parameters], particles.spacing and physics.gravity into `spec`, and into
/// `context` the dimension and the named numbers. Parameters, dx and g may use one another in any order. Throws
/// CaseError for a format of a newer program.
void read_foundations(CaseSpec& spec, Context& context, const toml::table& root);

}  // namespace tailwater
