#pragma once

#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// Solves the flow's pressure rows. `pressure` [Pa, one entry per particle] holds the guess, then on owned particles
/// the solution. Of the guess only the water's matters where walls look at water alone, as dummies do: rows that are
/// not the fluid's equation begin with what they make of the guess around them. Collective.
template <int Dim>
SolveReport solve_rows(Flow<Dim>& flow, std::vector<double>& pressure, double tolerance);

/// What a projection tells of its solve.
PressureReport report_of(const SolveReport& solved);

}  // namespace tailwater
