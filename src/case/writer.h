// The effective case: the case as a run used it, written as a case file.
#pragma once

#include <string>

#include "case/spec.h"

namespace tailwater {

/// TOML text with every key that applies, each followed by its unit and meaning. Expressions appear as their values.
/// read_case of this text gives `spec` again, bit for bit, if `spec` came from read_case.
std::string effective_case(const CaseSpec& spec);

}  // namespace tailwater
