// Linear theory of waves over an even bed, and of the plates that generate them: R.G. Dean, R.A. Dalrymple, Water Wave
// Mechanics for Engineers and Scientists (1991), ch. 3 and 6. docs/theory/waves.md has the derivations.
#pragma once

#include <vector>

#include "case/choices.h"

namespace tailwater {

/// The wave number k [1/m] of a wave of angular frequency `omega` [1/s]: omega^2 = g k tanh kh.
double wave_number(double omega, double gravity, double depth);

/// The wave number k_j [1/m], j = 1, 2, ..., of the evanescent waves beside a plate: omega^2 = -g k tan kh.
double near_field_wave_number(double omega, double gravity, double depth, int j);

/// cosh(a z)/cosh(a h) and sinh(a z)/cosh(a h), without overflow: the profile of a wave at the height z above the bed.
struct DepthShape {
  DepthShape(double a, double z, double h);
  double cosh, sinh;
};

/// Waves of a plate that oscillates by X sin(omega t) at the still water level: the progressive wave a cos(omega t - k
/// x), and the evanescent elevation X sin(omega t) sum c_j exp(-k_j x).
struct MakerTransfer {
  double wave;  ///< a/X
  struct NearField {
    double wave_number;  ///< k_j, 1/m
    double share;        ///< c_j
  };
  std::vector<NearField> near_field;

  /// The sum over j at `distance` [m] from the plate.
  double near_field_at(double distance) const;
};

MakerTransfer maker_transfer(MakerType type, double omega, double gravity, double depth);

/// Fraction of the wave amplitude that an absorbing plate reflects, if its gain is tuned to their frequency.
double plate_reflection(MakerType type, double omega, double gravity, double depth);

/// The largest height [m] of waves of angular frequency `omega` [1/s]: R. Miche (1944).
double breaking_height(double omega, double gravity, double depth);

}  // namespace tailwater
