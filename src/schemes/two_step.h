// One step of scheme B: Farmani, Barani & Ghaeini-Hessaroeyeh (2020), after Shao & Lo (2003).
#pragma once

#include "schemes/flow.h"

namespace tailwater {

/// (B10)-(B17): the pressure at the predicted positions, where the particles are left.
template <int Dim>
SolveReport predict_pressure(Flow<Dim>& flow, double dt, Interventions& interventions);

/// Two fractional steps (B10)-(B19): the particles move as if there were no pressure, and the pressure then undoes the
/// compression which that caused. Densities are summed anew from the positions wherever particles have moved.
template <int Dim>
StepReport two_step(Flow<Dim>& flow, double dt);

}  // namespace tailwater
