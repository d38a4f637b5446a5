// The time-step rule, (F40) and (F41), or (B20), and the limit of the explicit viscous term.
//
//   dt <= alpha dx / max(u_max, sqrt(2 g L)),    dt <= b dx^2 / nu_max
//
// b is 1/8, or the 0.1 of (B20). The explicit two-point term is stable up to 0.14 with a support of 2 dx, the smallest,
// and up to 0.32 with the default, in 2D and 3D (docs/theory/closures.md). The other half of (B20) is the first rule.
// With the density source (B17) the first rule feeds itself: to undo a density error in one step a particle needs a
// speed proportional to 1/dt, and that speed shortens the next step. So `fastest` caps u_max there.
//
// The paper uses (F41) at the start only. Here it always holds: it costs nothing in violent flow, where u_max is
// larger, and prevents huge steps in quiet water. The eddy viscosity of published/smagorinsky.h is at most of the order
// 0.01 u dx, far too small to limit the step.
#pragma once

#include <algorithm>
#include <limits>

namespace tailwater {

struct TimeStepRule {
  double courant = 0.0;                                      ///< alpha
  double spacing = 0.0;                                      ///< m; dx
  double fastest = std::numeric_limits<double>::infinity();  ///< m/s; cap of u_max
  double reference_speed = 0.0;                              ///< m/s; sqrt(2 g L)
  double viscous_share = 0.125;                              ///< b

  /// Speed [m/s] of the first rule.
  double limiting_speed(double speed) const { return std::max(std::min(speed, fastest), reference_speed); }

  /// Whether a viscosity [m^2/s] limits the step of water at the reference speed more than that speed does.
  bool is_viscous(double viscosity) const { return largest(0.0, viscosity) < largest(0.0, 0.0); }

  /// Largest step [s]; infinite when nothing moves and no force acts.
  double largest(double speed, double viscosity) const {
    const double infinite = std::numeric_limits<double>::infinity();
    const double limiting = limiting_speed(speed);
    const double advective = limiting > 0.0 ? courant * spacing / limiting : infinite;
    const double viscous = viscosity > 0.0 ? viscous_share * spacing * spacing / viscosity : infinite;
    return std::min(advective, viscous);
  }
};

}  // namespace tailwater
