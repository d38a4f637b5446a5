// The drawable parts of a case whose geometry is wrong, so that its user sees the place of the error.
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

/// All valid parts of a wrong case. Walls that cannot be made are left out, except that a mesh that cannot be a wall
/// gives its triangles. There is no water unless all walls can be made.
template <int Dim>
BrokenCase<Dim> draw_broken_case(const CaseSpec& spec);

/// The places that a picture marks, from the findings.
template <int Dim>
std::vector<Vec<Dim>> places_of(const Findings& findings);

}  // namespace tailwater
