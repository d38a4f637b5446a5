// What can be drawn of a case whose geometry is wrong, so that its user sees where.
#pragma once

#include <string_view>
#include <vector>

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

/// The places "(0.5, 1.25)" with Dim coordinates that a message names, as `place` in from_spec.h writes them. A picture
/// then marks exactly what its user reads.
template <int Dim>
std::vector<Vec<Dim>> places_in(std::string_view message);

}  // namespace tailwater
