// What can be drawn of a case whose geometry is wrong, so that its user sees where.
#pragma once

#include <vector>

#include "base/finding.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "sampling/fluid_particles.h"

namespace tailwater {

/// The walls of a case, and its water where that can be made.
template <int Dim>
struct BrokenCase {
  Boundary<Dim> boundary;
  FluidParticles<Dim> fluid;
};

/// All that can be made of a wrong case: walls that cannot be made are left out, but of a mesh that cannot be a wall
/// there are its triangles. There is no water unless all walls can be made.
template <int Dim>
BrokenCase<Dim> draw_broken_case(const CaseSpec& spec);

/// The places that a picture marks: those that the findings name.
template <int Dim>
std::vector<Vec<Dim>> places_of(const Findings& findings);

}  // namespace tailwater
