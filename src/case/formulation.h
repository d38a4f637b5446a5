// The two sets of defaults of [scheme]: `robust` is what SchemeTable's initialisers say, `published` is the scheme as
// Farzin, Hassanzadeh, Aalami and Fatehi (2014) published it.
#pragma once

#include "case/spec.h"

namespace tailwater {

/// Sets the keys that depend on `scheme.formulation` and `scheme.integrator` to their defaults. With `robust` only the
/// implicit integrator's alpha, 0.5, differs from the initialisers. To be called before the keys given in the file are
/// read.
///
/// Published: kernel (F8), consistent operators (B1, B2), p = 0 on detected surface particles, pressure rows on the
/// wall (F36-F39), c_a = 0.20 (F3) without a floor, c_s = 0.10 (F4-F6), shifting (F28-F32) with eps = 0.10 explicit or
/// 0.08 implicit, alpha = 0.05 explicit or 0.12 implicit (F40), under-relaxation 0.4, 0.3, 0.4 in up to 30 passes, no
/// correction of the density. The cap of the shift, 0.05 dx, is not the paper's. Surface detection is by the cone; the
/// paper's own (F35) is `surface = "farzin"`.
void apply_formulation(SchemeTable& scheme);

}  // namespace tailwater
