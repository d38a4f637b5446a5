// What a run that fails leaves behind: which particle went wrong, what surrounds it, and the last good fields.
#pragma once

#include <optional>
#include <string>

#include "flow/flow.h"
#include "io/run_folder.h"

namespace tailwater {

/// The first owned fluid particle whose position, velocity, predicted velocity or pressure is not finite.
template <int Dim>
std::optional<std::size_t> find_non_finite(const Flow<Dim>& flow);

/// Collective; `culprit` on the rank that has it. Writes failure/last_good.vtp (the state before the failed step) and
/// failure/report.txt: `message`, and if it is known the `culprit` with its neighbours. `flow` is the state after the
/// step, or, if the step was not taken, before it; its particles are in the order of those in `last_good`. Throws
/// IoError.
template <int Dim>
void write_failure(const RunFolder& folder, const Flow<Dim>& flow, const Particles<Dim>& last_good,
                   double last_good_time, std::optional<std::size_t> culprit, const std::string& message);

}  // namespace tailwater
