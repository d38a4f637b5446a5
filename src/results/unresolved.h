// Warnings about water surfaces that the particles of a run have not resolved, from the readings of its probes.
#pragma once

#include "base/finding.h"
#include "case/spec.h"
#include "flow/setup.h"
#include "io/run_folder.h"

namespace tailwater {

/// A warning for all gauges at which the water was never deeper than the lowest resolved wave, and one, in a case with
/// wave makers, for all gauges whose surface moved by less than that. Both cover probes of depth; the warning about
/// waves also covers those of run-up. Throws IoError if a table cannot be read. Call on the root.
template <int Dim>
Findings unresolved_surfaces(const CaseSpec& spec, const RunFolder& folder, const Setup<Dim>& setup);

}  // namespace tailwater
