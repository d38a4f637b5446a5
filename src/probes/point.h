// Pressure and velocity at a fixed point: moving least squares over the fluid within the support, exact for linear
// fields (Levin 1998), with q_j = (1, (x_j - x)/R):
//
//   f(x) = sum w W (a . q_j) f_j,    M a = (1, 0, ..),    M = sum w W q_j q_j^T
//
// Derivatives are those of the fitted linear field. Where the neighbours do not span space (M nearly singular), a =
// (1/M_00, 0, ..), which gives the Shepard mean. Where there is no water, c(x) <= 1/2 (water_share.h), all values and
// the column `wet` are 0.
#pragma once

#include "case/spec.h"
#include "probes/context.h"

namespace tailwater {

/// The velocity at `x` [m/s]; zero where no fluid is within the support.
template <int Dim>
Vec<Dim> velocity_at(const ProbeContext<Dim>& context, const Vec<Dim>& x);

template <int Dim>
Reading<Dim> pressure_reading(const ProbeTable& probe);

/// With the shear rate, the viscosity and the stress by the law of the probe's liquid, if it has one.
template <int Dim>
Reading<Dim> velocity_reading(const ProbeTable& probe, const CaseSpec& spec);

}  // namespace tailwater
