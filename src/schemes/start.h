// The initial pressure, computed in the order of the first step. Afterwards all particles are where they were.
#pragma once

#include "flow/flow.h"
#include "flow/step.h"

namespace tailwater {

/// Computes the pressure and the forces on walls by the first projection of a step of length dt, for walls that are
/// driven so. Changes no velocity. Call after `locate`.
template <int Dim>
void project_in_place(Flow<Dim>& flow, const StepStart<Dim>& start, WallDrive<Dim> drive, double dt);

/// Computes it by the first projection of a step of length dt, with walls that reach their velocity at its end.
template <int Dim>
void project_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// Computes it by the two-step scheme, at the positions predicted for dt.
template <int Dim>
void predict_pressure_at_start(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
