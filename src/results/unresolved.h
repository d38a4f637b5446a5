// Warnings of a run about water surfaces that its particles have not resolved, from what its probes have read.
#pragma once

#include <string>
#include <vector>

#include "case/spec.h"
#include "io/run_folder.h"

namespace tailwater {

/// A line for all gauges whose surface moved by less than the lowest resolved wave in a case with wave makers, and one
/// for all gauges at which the water was never deeper than that. Both are for probes of depth; waves also for those of
/// run-up. Throws IoError if a table cannot be read. By the root.
std::vector<std::string> unresolved_surfaces(const CaseSpec& spec, const RunFolder& folder);

}  // namespace tailwater
