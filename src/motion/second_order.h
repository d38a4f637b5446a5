// Second-order theory of plates that make regular waves: the motion of twice the frequency that leaves only the bound
// wave in front of the plate. H.A. Schaffer (1996) Second-order wavemaker theory for irregular waves, Ocean Eng. 23,
// 47-88; docs/theory/waves.md derives the form that is used here.
#pragma once

#include <complex>

#include "case/choices.h"

namespace tailwater {

/// The stroke [m] X_2, so that X_2 exp(2 i omega t) accompanies the first-order motion `stroke` exp(i omega t) [m],
/// both at the still water's level and as real parts.
std::complex<double> second_harmonic_stroke(MakerType type, double omega, std::complex<double> stroke, double gravity,
                                            double depth);

}  // namespace tailwater
