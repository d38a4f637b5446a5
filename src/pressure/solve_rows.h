#pragma once

#include <vector>

#include "flow/flow.h"
#include "linear/linear_solver.h"

namespace tailwater {

/// Solves the flow's pressure rows. `pressure` [Pa, one entry per particle] holds the guess, then on owned particles
/// the solution. Rows that are not the fluid's equation are first evaluated with the guess around them. Where rows of
/// walls depend on water alone, as those of dummies do, only the guess of the water therefore matters. Collective.
template <int Dim>
SolveReport solve_rows(Flow<Dim>& flow, std::vector<double>& pressure, double tolerance);

/// The report of a projection about its solve.
PressureReport report_of(const SolveReport& solved);

}  // namespace tailwater
