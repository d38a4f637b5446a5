// The files of a failed run: a report of the failed particle and its surroundings, and the last good fields.
#pragma once

#include <optional>
#include <string>

#include "flow/flow.h"
#include "io/run_folder.h"

namespace tailwater {

/// The first owned fluid particle whose position, velocity, pressure or source of the pressure equation is not finite.
template <int Dim>
std::optional<std::size_t> find_non_finite(const Flow<Dim>& flow);

/// Writes failure/last_good.vtp (the state before the failed step) and failure/report.txt: `message` and, if known, the
/// `culprit` with its neighbours. `culprit` is set on the rank that has it. `flow` is the state after the step, or
/// before it if the step was not taken. Its particles are in the order of those in `last_good`. Collective. Throws
/// IoError.
template <int Dim>
void write_failure(const RunFolder& folder, const Flow<Dim>& flow, const Particles<Dim>& last_good,
                   double last_good_time, std::optional<std::size_t> culprit, const std::string& message);

}  // namespace tailwater
