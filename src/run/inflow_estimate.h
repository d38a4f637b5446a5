// How much water a case will hold while it runs, as far as what comes in and leaves can be told without running it.
#pragma once

#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

struct WaterEstimate {
  double mean = 0.0;           ///< m^Dim; over the run
  double largest = 0.0;        ///< m^Dim
  double largest_speed = 0.0;  ///< m/s; at the open ends, and of what falls from them
};

/// Takes the case for a basin as wide as the box around its walls, whose level rises and falls evenly by what its open
/// ends bring and take: what is prescribed, what runs towards a level that is prescribed as over a sill (the critical
/// discharge), and the same where the channel goes on. `start` [m^Dim] is the water at the start.
template <int Dim>
WaterEstimate estimate_water(const CaseSpec& spec, const Boundary<Dim>& boundary, double start);

}  // namespace tailwater
