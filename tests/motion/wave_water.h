// The water of the tests of waves.
#pragma once

#include <cmath>

namespace tailwater::wave_water {

inline constexpr double g = 9.81;
inline constexpr double h = 0.4;

/// The angular frequency of waves of this kh.
inline double omega_at(double kh) { return std::sqrt(g * kh / h * std::tanh(kh)); }

}  // namespace tailwater::wave_water
