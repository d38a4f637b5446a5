// The numbers that the expressions of a case may use by name, besides pi.
#pragma once

#include "case/expression.h"
#include "case/spec.h"

namespace tailwater {

/// m/s^2; the number `g`.
double gravity_magnitude(const PhysicsTable& physics);

/// Whether gravity is within 60 degrees of the way down along the last axis: axes may be turned along a sloping bed.
bool gravity_points_down(const PhysicsTable& physics);

/// The parameters, `dx` and `g` of a case that has been read.
NamedNumbers named_numbers(const CaseSpec& spec);

}  // namespace tailwater
