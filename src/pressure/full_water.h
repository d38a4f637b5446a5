// Water that fills its walls. No surface fixes its pressure, which is known up to a constant, and it can neither expand
// nor shrink on average. Its equation is solved without the mean of its source, and the least pressure is 0 then, so
// that nothing pulls.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// 1 where water fills its walls, 0 where as much as a particle is beside air, and between the two in between. 0 where
/// open ends or marks of the surface fix the pressure. Collective.
template <int Dim>
double find_fullness(const Flow<Dim>& flow);

/// Takes the mean of a source of the water's rows (owned) out of it, as far as the water is full. Collective.
template <int Dim>
void take_out_mean(const Flow<Dim>& flow, double fullness, std::vector<double>& source);

/// Adds to `part` of the pressure `rest` + `part` (owned; no `rest`: 0), as far as the water is full, what makes the
/// least of it 0. Collective.
template <int Dim>
void shift_minimum_to_zero(const Flow<Dim>& flow, double fullness, std::span<const double> rest,
                           std::span<double> part);

}  // namespace tailwater
