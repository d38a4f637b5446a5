// How many particles a case will have, before any is made.
#pragma once

#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

/// Expected particles, from the lengths, areas and volumes of the shapes. Doubles, because a mistyped spacing may give
/// more than an integer can hold.
struct ParticleCount {
  double fluid = 0.0;
  double wall = 0.0;
};

/// Throws InputError as make_fluid_particles does, but makes no particles.
template <int Dim>
ParticleCount expected_particle_count(const CaseSpec& spec, const Boundary<Dim>& boundary);

}  // namespace tailwater
