// What acts in the next step beside what the case says: forces of a program that uses this one as a library.
#pragma once

#include <vector>

#include "base/vec.h"
#include "motion/floating_body.h"

namespace tailwater {

/// Empty fields add nothing, and a step without loads is bit for bit what it is without this struct.
template <int Dim>
struct Loads {
  std::vector<Vec<Dim>> acceleration;  ///< m/s^2; force per mass on each owned particle; only water feels it
  std::vector<Twist<Dim>> on_bodies;   ///< N, N m, in 2D per metre of width; on each body, about its centre of mass
};

}  // namespace tailwater
