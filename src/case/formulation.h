// The defaults of [scheme] by `name` and `formulation`. SchemeTable's initialisers are those of farzin2014, robust.
#pragma once

#include "case/spec.h"

namespace tailwater {

/// Sets the keys that depend on `scheme.name`, `scheme.formulation` and `scheme.integrator` to their defaults. Call it
/// on the initialisers, before the keys given in the file are read.
///
/// farzin2014, robust: only the implicit integrator's alpha, 0.6, differs from the initialisers.
///
/// farzin2014, published (Farzin, Hassanzadeh, Aalami & Fatehi 2014): kernel (F8), consistent operators (B1, B2), p = 0
/// on detected surface particles, pressure rows on the wall (F36-F39), c_a = 0.20 (F3) without a floor, c_s = 0.10
/// (F4-F6), shifting (F28-F32) with eps = 0.10 explicit or 0.08 implicit, alpha = 0.05 explicit or 0.12 implicit (F40),
/// under-relaxation 0.4, 0.3, 0.4 in up to 30 passes, no correction of the density. The cap of the shift, 0.05 dx, is
/// not the paper's. Surface detection is by the cone; the paper's own (F35) is `surface = "farzin"`.
///
/// farmani2020, published (Farmani, Barani & Ghaeini-Hessaroeyeh 2020): cubic spline (B5) with h = 1.2 dx, gradient
/// (B7), Laplacian and viscous term (B8, B9), density source in full (B17), surface by density ratio (B21), one row on
/// the wall and dummies behind it, molecular viscosity only, moved by the mean velocity (B19), alpha = 0.1 (B20). The
/// paper gives no number for beta: 0.99 is ours (docs/theory/two-step.md).
///
/// farmani2020, robust: docs/theory/two-step.md says why.
void apply_formulation(SchemeTable& scheme);

}  // namespace tailwater
