// The lag of the pressure behind viscous forces.
//
// A step solves for the velocity v that viscous forces and the last pressure leave, and the projection then gives it
// the change of the pressure (thick_liquid.h). Where a wall or an inlet pushes a thick liquid through a passage, the
// pressure is mu u L/h^2. The projection adds at most rho u L/dt to it in a step, and the expansion of v mu u/L. Long
// steps then compress the liquid, or push it as if it had no viscosity, before the pressure has grown.
#pragma once

#include <span>

#include "flow/flow.h"

namespace tailwater {

/// The velocity that the change of the pressure adds in a step, relative to the velocity `before` that change (owned
/// particles), both as root mean squares. It is averaged over neighbours three times, so that it does not contain what
/// disorder and the density source move. A velocity below that of the walls and openings that push the liquid counts as
/// that. 0 if nothing pushes: a slump that has come to rest has only disorder left. Collective.
template <int Dim>
double change_by_pressure(const Flow<Dim>& flow, std::span<const Vec<Dim>> before);

/// s; the longest next step after one of `dt` with this change. The change is limited to 3 %: a squeezed film then has
/// its force within 10 %, and free surface flows keep their steps. `shortest`: the step [s] at which viscous forces
/// would be stable without a solve, so that nothing lags.
double longest_step_after(double change, double dt, double shortest);

}  // namespace tailwater
