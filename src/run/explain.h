// What a case is, in a few sentences that an engineer can check against what was meant.
#pragma once

#include <string>
#include <vector>

#include "case/spec.h"
#include "run/estimate.h"

namespace tailwater {

/// Of the water, the walls and what moves, the open ends, the measurements, the method, and what the run takes.
std::vector<std::string> explain_case(const CaseSpec& spec, const RunEstimate& estimate);

}  // namespace tailwater
