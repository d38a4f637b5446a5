// The time-step rule, (F40) and (F41), and the limit of the explicit viscous term.
//
//   dt <= alpha dx / max(u_max, sqrt(2 g L)),    dt <= 0.25 dx^2 / (Dim nu_max)
//
// The paper uses (F41) at the start only; kept throughout it costs nothing in violent flow, where u_max is larger, and
// keeps quiet water from taking huge steps. The eddy viscosity of smagorinsky.h is at most of the order 0.01 u dx, far
// below what would limit the step.
#pragma once

#include <algorithm>
#include <limits>

namespace tailwater {

struct TimeStepRule {
  double courant = 0.0;          ///< alpha
  double spacing = 0.0;          ///< m; dx
  double reference_speed = 0.0;  ///< m/s; sqrt(2 g L)
  int dimension = 2;

  /// Largest step [s]; infinite when nothing moves and nothing pulls.
  double largest(double speed, double viscosity) const {
    const double limiting_speed = std::max(speed, reference_speed);
    const double infinite = std::numeric_limits<double>::infinity();
    const double advective = limiting_speed > 0.0 ? courant * spacing / limiting_speed : infinite;
    const double viscous = viscosity > 0.0 ? 0.25 * spacing * spacing / (dimension * viscosity) : infinite;
    return std::min(advective, viscous);
  }
};

}  // namespace tailwater
