// One step of scheme B: Farmani, Barani & Ghaeini-Hessaroeyeh (2020), after Shao & Lo (2003).
#pragma once

#include "flow/flow.h"
#include "flow/step.h"
#include "pressure/verbs.h"

namespace tailwater {

/// The pressure at the predicted positions, and what it was made from.
template <int Dim>
struct PredictedPressure {
  Prediction<Dim> predicted;
  PosedEquation equation;
  PressureReport solved;
};

/// (B10)-(B17): predicts, moves the particles there, leaves them there, and finds the pressure.
template <int Dim>
PredictedPressure<Dim> predict_pressure(Flow<Dim>& flow, const StepStart<Dim>& start, const WallDrive<Dim>& drive,
                                        double dt);

/// Two fractional steps (B10)-(B19): the particles move as if there were no pressure, and the pressure then undoes the
/// compression which that caused. Densities are summed anew from the positions wherever particles have moved.
template <int Dim>
StepReport two_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
