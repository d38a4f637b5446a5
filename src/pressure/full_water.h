// Water that fills its walls. No surface fixes its pressure, which is known up to a constant, and it can neither expand
// nor shrink on average. Its equation is solved without the mean of its source. The pressure is then shifted so that
// its minimum is 0 and there is no tension.
#pragma once

#include "flow/balanced_pressure.h"
#include "flow/flow.h"

namespace tailwater {

/// Subtracts the mean, times the fullness, from a source of the water's rows (owned). Collective.
template <int Dim>
void take_out_mean(const Flow<Dim>& flow, double fullness, std::vector<double>& source);

/// Adds a constant, times the fullness, to `part` so that the minimum of the pressure `rest` + `part` (owned; no
/// `rest`: 0) is 0. Collective.
template <int Dim>
void shift_minimum_to_zero(const Flow<Dim>& flow, double fullness, std::span<const double> rest,
                           std::span<double> part);

}  // namespace tailwater
