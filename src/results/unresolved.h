// Warnings about water surfaces that the particles of a run have not resolved, from the readings of its probes.
#pragma once

#include <string>
#include <vector>

#include "case/spec.h"
#include "flow/setup.h"
#include "io/run_folder.h"

namespace tailwater {

/// One line for all gauges at which the water was never deeper than the lowest resolved wave. One line, in a case with
/// wave makers, for all gauges whose surface moved by less than that. Both cover probes of depth; the line about waves
/// also covers those of run-up. Throws IoError if a table cannot be read. Call on the root.
template <int Dim>
std::vector<std::string> unresolved_surfaces(const CaseSpec& spec, const RunFolder& folder, const Setup<Dim>& setup);

}  // namespace tailwater
