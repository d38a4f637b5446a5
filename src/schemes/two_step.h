// One step of scheme B: Farmani, Barani & Ghaeini-Hessaroeyeh (2020), after Shao & Lo (2003).
#pragma once

#include "flow/flow.h"
#include "flow/step.h"
#include "pressure/stages.h"

namespace tailwater {

/// Report of the pressure at the predicted positions, with the prediction and the equation it was found from.
template <int Dim>
struct PredictedPressure {
  Prediction<Dim> predicted;
  PosedEquation equation;
  PressureReport solved;
};

/// (B10)-(B17): predicts, moves the particles to the predicted positions, and finds the pressure there. The particles
/// stay there.
template <int Dim>
PredictedPressure<Dim> predict_pressure(Flow<Dim>& flow, const StepStart<Dim>& start, WallDrive<Dim>& drive, double dt);

/// Two fractional steps (B10)-(B19): the particles move as if there were no pressure; the pressure then undoes the
/// compression this caused. Densities are summed again from the positions after every move.
template <int Dim>
StepReport two_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt);

}  // namespace tailwater
