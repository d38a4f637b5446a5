#include "case/named_numbers.h"

#include <cmath>

namespace tailwater {

double gravity_magnitude(const PhysicsTable& physics) {
  double magnitude = 0.0;
  for (const double component : physics.gravity) magnitude = std::hypot(magnitude, component);
  return magnitude;
}

bool gravity_points_down(const PhysicsTable& physics) {
  constexpr double min_downward = 0.5;  // cosine of the angle
  return physics.gravity.back() <= -min_downward * gravity_magnitude(physics);
}

NamedNumbers named_numbers(const CaseSpec& spec) {
  NamedNumbers numbers{{"dx", spec.particles.spacing}, {"g", gravity_magnitude(spec.physics)}};
  for (const Parameter& parameter : spec.parameters) numbers[parameter.name] = parameter.value;
  return numbers;
}

}  // namespace tailwater
