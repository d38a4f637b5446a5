// Linear theory of waves over an even bed, and of the plates that make them: R.G. Dean, R.A. Dalrymple, Water Wave
// Mechanics for Engineers and Scientists (1991), ch. 3 and 6. docs/theory/waves.md derives what is used here.
#pragma once

#include <vector>

#include "case/choices.h"

namespace tailwater {

/// The wave number k [1/m] of a wave of angular frequency `omega` [1/s]: omega^2 = g k tanh kh.
double wave_number(double omega, double gravity, double depth);

/// What a plate that oscillates by X sin(omega t) at the still water's level makes: the wave a cos(omega t - k x), and
/// beside it the elevation X sin(omega t) sum c_j exp(-k_j x), which does not travel.
struct MakerTransfer {
  double wave;  ///< a/X
  struct NearField {
    double wave_number;  ///< k_j, 1/m
    double share;        ///< c_j
  };
  std::vector<NearField> near_field;

  /// The sum at a distance [m] from the plate.
  double near_field_at(double distance) const;
};

MakerTransfer maker_transfer(MakerType type, double omega, double gravity, double depth);

}  // namespace tailwater
