// How far the solves of a step go that are not its last word on the pressure.
#pragma once

#include <cmath>

namespace tailwater {

/// Tolerance of a rough solve beside one that reaches `tolerance`. The first projection asks it where water near the
/// surface would pull: rows whose rough pressure is that close to 0 may be taken for pulling, or not, by mistake. The
/// second projection needs no more, since what it corrects is small. Of what the responses to pockets of air leave, the
/// water's pressure mends all but their part in the change of a pocket's pressure.
inline double rough_tolerance(double tolerance) { return std::pow(tolerance, 0.6); }

}  // namespace tailwater
