// One step of scheme F by either time integrator.
#pragma once

#include "schemes/flow.h"

namespace tailwater {

/// Explicit projection (F14)-(F17): all derivatives at the old positions, so that div u' = 0 holds there (F18).
template <int Dim>
StepReport explicit_projection_step(Flow<Dim>& flow, double dt);

/// Implicit projection (F20)-(F27): iterated until the derivatives are those at the new positions (F19).
template <int Dim>
StepReport implicit_projection_step(Flow<Dim>& flow, double dt);

/// Implicit projection in residual form: the explicit step, then a second projection of the velocity at the new
/// positions, of what the move and the first projection left (F19). The velocity is divergence-free at both ends of the
/// step, and midway while it moves the particles: the velocity half of RATTLE (Andersen 1983), symmetric in time.
template <int Dim>
StepReport two_projections_step(Flow<Dim>& flow, double dt);

/// Finds the pressure at the start, so that the first measurements show it and the first step starts from it. Nothing
/// moves.
template <int Dim>
void start(Flow<Dim>& flow);

/// A step by the integrator that the case chose; advances flow.time and flow.step.
template <int Dim>
StepReport advance(Flow<Dim>& flow, double dt);

}  // namespace tailwater
