// A summary of a case in a few sentences, with which an engineer can check the case.
#pragma once

#include <string>
#include <vector>

#include "case/spec.h"
#include "run/estimate.h"

namespace tailwater {

/// Sentences about the water, the walls and moving parts, the open ends, the measurements, the method and the cost.
std::vector<std::string> explain_case(const CaseSpec& spec, const RunEstimate& estimate);

}  // namespace tailwater
