// What is wrong with the paths of walls that move, found before anything runs.
#pragma once

#include <vector>

#include "geometry/check.h"

namespace tailwater {

/// Errors: a wall that is not where it is drawn at t = 0, whose place is not finite, that is faster than water can be
/// taken for incompressible, that crosses a wall, that comes so near to one that the water between is crushed, or that
/// leaves less room than there is water where it cannot get out; each with time and place; with rows of particles on
/// walls, bodies nearer than dx to each other at the start. A warning: a resting wall
/// that ends where a moving one begins. The paths are followed in steps of dx/4 from the start to the end of the run.
template <int Dim>
std::vector<Finding> check_motion(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid);

}  // namespace tailwater
