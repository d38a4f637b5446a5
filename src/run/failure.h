// What a run that fails leaves behind: which particle went wrong, what surrounds it, and the last good fields.
#pragma once

#include <optional>
#include <string>

#include "io/run_folder.h"
#include "schemes/flow.h"

namespace tailwater {

/// The first owned fluid particle whose position, velocity or pressure is not finite.
template <int Dim>
std::optional<std::size_t> find_non_finite(const Particles<Dim>& particles);

/// Writes failure/last_good.vtp (the state before the failed step) and failure/report.txt. `culprit` is a particle of
/// `flow` after the step, if one is known. Returns the text of the report.
template <int Dim>
std::string write_failure(const RunFolder& folder, const Flow<Dim>& flow, const Particles<Dim>& last_good,
                          double last_good_time, std::optional<std::size_t> culprit, const std::string& message);

}  // namespace tailwater
