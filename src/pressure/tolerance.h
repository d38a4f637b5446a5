// Tolerances of those solves of a step that do not determine its final pressure.
#pragma once

#include <cmath>

namespace tailwater {

/// Tolerance of a rough solve in addition to one that reaches `tolerance`. The first projection uses it to find tension
/// of water near the surface: rows whose rough pressure is within this tolerance of 0 may be misjudged. The second
/// projection needs no better tolerance, since its correction is small, and neither does the first guess of a response
/// to a pocket of air.
inline double rough_tolerance(double tolerance) { return std::pow(tolerance, 0.6); }

/// Tolerance of a pass for the response to a pocket, which corrects the remainder of the previous pass; any response
/// conserves the energy of water and gas.
inline double tolerance_of_pass(double tolerance) { return std::pow(tolerance, 0.4); }

}  // namespace tailwater
