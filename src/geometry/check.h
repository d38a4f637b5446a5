// What is wrong with a case's geometry, found before anything runs. Every message names the place, the value and the
// remedy.
#pragma once

#include <string>
#include <vector>

#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/sampling.h"

namespace tailwater {

enum class Severity { warning, error };

struct Finding {
  Severity severity = Severity::error;
  std::string message;
};

/// Errors: no fluid or a block smaller than the spacing, overlapping blocks, fluid behind a wall, on both sides of it
/// or too near to it, a wall that crosses itself, has a crest above its ends or is thinner than its layers of dummy
/// particles, a place where the fluid would pour out, an outlet that overlaps a wall, cuts through water or leaves a
/// gap to the walls, a periodic direction narrower than four supports, a moving wall on an impossible path
/// (check_motion.h). Warnings: a gap between fluid and wall, a block that is not a whole number of dx long. Cost:
/// proportional to particles times nearby faces, and to the cells of size dx that the water can reach.
template <int Dim>
std::vector<Finding> check_geometry(const CaseSpec& spec, const Boundary<Dim>& boundary,
                                    const FluidParticles<Dim>& fluid);

/// Particles to come, counted from the shapes' measures; a double, since a mistyped spacing asks for more than an
/// integer can hold.
struct ParticleCount {
  double fluid = 0.0;
  double wall = 0.0;
};

/// Throws InputError like make_boundary and make_fluid_particles do, but makes no particle.
template <int Dim>
ParticleCount expected_particle_count(const CaseSpec& spec);

/// Particles within the kernel's support (in dx) of a particle on a regular lattice.
template <int Dim>
double neighbours_in_support(double support);

/// Memory of a run, bytes: `particles` of fluid, particles of the `walls`, mean number of `neighbours`. An estimate
/// from above of what the stages hold at once: fields, neighbour lists with kernel values, matrix and preconditioner.
template <int Dim>
double memory_estimate(double particles, double walls, double neighbours);

/// Memory that programs can still take on this machine, bytes (MemAvailable of /proc/meminfo). Throws IoError.
double available_memory();

/// To be called before any particle is made: an error when the case needs more than `available` bytes.
template <int Dim>
std::vector<Finding> check_memory(const CaseSpec& spec, double available);

}  // namespace tailwater
