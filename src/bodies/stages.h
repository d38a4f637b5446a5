// The stages of bodies that float: what the order of a step calls. Without bodies they do nothing, and
// `solve_with_bodies` is the pressure's own `solve`.
#pragma once

#include "pressure/stages.h"

namespace tailwater {

/// Sets out from the acceleration of the last step. Call at the start of a step.
template <int Dim>
void steer_bodies(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

/// The pressure, and the motion of the bodies with it (coupling.h). `drive` follows the bodies.
template <int Dim>
PressureReport solve_with_bodies(Flow<Dim>& flow, const StepStart<Dim>& start, const PosedEquation& equation, double dt,
                                 WallDrive<Dim>& drive);

/// The impulses of the second projection's pressure during dt reach the bodies in the next step. Collective.
template <int Dim>
void carry_over_second_pressure(Flow<Dim>& flow, const std::vector<double>& correction, double dt);

/// The same of what the last guard took from the water in front of bodies in this step of dt. Collective.
template <int Dim>
void carry_over_guard(Flow<Dim>& flow, double dt);

}  // namespace tailwater
