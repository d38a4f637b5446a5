// Second-order theory of plates that make waves: the motion of the sum and of the difference of two frequencies that
// leaves only the bound wave in front of the plate. H.A. Schaffer (1996) Second-order wavemaker theory for irregular
// waves, Ocean Eng. 23, 47-88; docs/theory/waves.md derives the form that is used here.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "case/choices.h"

namespace tailwater {

/// A motion of first order: the real part of stroke exp(i omega t) at the still water's level.
struct PlateMotion {
  double omega;                 ///< 1/s
  std::complex<double> stroke;  ///< m
};

/// The real part of stroke exp(i omega t) accompanies the motions of first order, whose bound wave is the real part of
/// elevation exp(i omega t - i wave_number x).
struct SecondOrderWave {
  double omega;                    ///< 1/s
  double wave_number;              ///< 1/m
  std::complex<double> stroke;     ///< m; at the still water's level
  std::complex<double> elevation;  ///< m
};

/// The wave of twice the frequency of one motion.
SecondOrderWave second_harmonic(MakerType type, const PlateMotion& motion, double gravity, double depth);

/// The waves of all sums and differences of the frequencies of `motions`, which are in ascending order, but for pairs
/// of small waves, which have 3 % of the squared products of amplitudes, and for differences below `slowest` [1/s].
std::vector<SecondOrderWave> second_order_waves(MakerType type, std::span<const PlateMotion> motions, double slowest,
                                                double gravity, double depth);

}  // namespace tailwater
