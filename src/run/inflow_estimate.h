// Estimates the amount of water in a case during a run from inflow and outflow, without running the case.
#pragma once

#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

struct WaterEstimate {
  double mean = 0.0;           ///< m^Dim; over the run
  double largest = 0.0;        ///< m^Dim
  double largest_speed = 0.0;  ///< m/s; at the open ends, and of water that falls from them
};

/// Replaces the case by a basin as wide as the box around its walls, whose level rises and falls evenly by the flow
/// through its open ends. That flow is the prescribed one, the flow towards a prescribed level as over a sill (the
/// critical discharge), and the same where the channel continues. `start` [m^Dim] is the water at the start.
template <int Dim>
WaterEstimate estimate_water(const CaseSpec& spec, const Boundary<Dim>& boundary, double start);

}  // namespace tailwater
