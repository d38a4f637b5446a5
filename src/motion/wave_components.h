// The sines of irregular waves and of focused groups.
#pragma once

#include <vector>

#include "case/spec.h"

namespace tailwater {

/// A wave a cos(omega t - k x + phase).
struct WaveComponent {
  double omega;      ///< 1/s
  double amplitude;  ///< m
  double phase;
};

/// Irregular waves have the significant height and random phases; their sines have random frequencies in bands of equal
/// width. In a focused group all crests meet at `focus`, and amplitudes are proportional to the spectrum, which is the
/// mean shape of the highest waves of a sea: P.S. Tromans et al. (1991) A new model for the kinematics of large ocean
/// waves, Proc. 1st Int. Offshore Polar Eng. Conf., 64-71.
std::vector<WaveComponent> wave_components(const WaveKeys& waves, double gravity, double depth);

/// Growth of the waves from rest, from 0 to 1 in the time `ramp`; smooth.
double ramp_at(double since, double ramp);

}  // namespace tailwater
