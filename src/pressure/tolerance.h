// How far the solves of a step go that are not its last word on the pressure.
#pragma once

#include <cmath>

namespace tailwater {

/// Tolerance of a rough solve beside one that reaches `tolerance`. The first projection asks it where water near the
/// surface would pull: rows whose rough pressure is that close to 0 may be taken for pulling, or not, by mistake. The
/// second projection needs no more, since what it corrects is small, nor the first guess of a response to a pocket of
/// air.
inline double rough_tolerance(double tolerance) { return std::pow(tolerance, 0.6); }

/// Of a pass for the response to a pocket, which takes up what the one before has left; any response keeps the energy
/// of water and gas.
inline double tolerance_of_pass(double tolerance) { return std::pow(tolerance, 0.4); }

}  // namespace tailwater
