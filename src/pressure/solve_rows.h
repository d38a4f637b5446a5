#pragma once

#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// Solves the flow's pressure rows. `pressure` [Pa, one entry per particle] holds the guess, then on owned particles
/// the solution. Rows that are not of water only look at the water: they begin with what they make of its guess, and
/// need no memory of their own. Collective.
template <int Dim>
SolveReport solve_rows(Flow<Dim>& flow, std::vector<double>& pressure, double tolerance);

}  // namespace tailwater
