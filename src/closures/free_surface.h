// Where the free surface is. Three tests, one result: a mark on surface particles.
//
//   air     C/C_0 < 0.85: a mark for the field files only; nothing in the scheme needs it
//   cone    no neighbour within 2.3 dx in a cone of opening 105 degrees around the outward normal -grad C, and
//           C/C_0 < 0.95; or fewer than 5 neighbours; or lambda_min(A) < 0.1. What worked in prototypes of the
//           published scheme, in place of (F35), which misses surface particles; the cone around the normal replaces
//           their angular gap, which is 2D only.
//   density (B21): C/C_0 < beta, where C/C_0 is rho/rho_0; or fewer than half the neighbours of a full lattice.
//           Without the second condition a clump in the air that is as dense as water would have p = 0 nowhere, and
//           its equation no solution
#pragma once

#include <cstdint>
#include <span>

#include "case/scheme_choices.h"
#include "operators/renormalisation.h"
#include "particles/particles.h"

namespace tailwater {

/// Input of the tests. `concentration` is C/C_0; only the cone needs `tensors`.
template <int Dim>
struct SurfaceInput {
  const Pairs<Dim>& pairs;
  const Particles<Dim>& particles;
  std::span<const double> concentration;
  std::span<const Vec<Dim>> concentration_gradient;
  std::span<const Renormalisation<Dim>> tensors;
  double spacing;
  double least_density;  ///< beta of (B21)
};

/// Marks owned fluid particles on the free surface. Only the `density` test marks wall particles, where density is low.
template <int Dim>
void find_free_surface(SurfaceTreatment test, const SurfaceInput<Dim>& input, std::span<std::uint8_t> is_surface);

/// How far inside the fluid each owned fluid particle is: 0 in the two outermost rows, 1 from the third row on; 0 for
/// walls. It is a smooth step, from 0.94 to 0.98, of the mean concentration Cm_i = sum W C_j/C_0 / sum W over the fluid
/// including the particle itself. At a flat surface Cm = 0.83, 0.93, 0.99, 1.00 row by row (2D). Continuous in the
/// positions. `concentration` must be up to date on ghosts.
template <int Dim>
void find_interior(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const double> concentration,
                   double W_0, std::span<double> interior);

/// The same from surface marks, for the published surface tests: 0 on marked particles and within 2 dx of them, else 1.
/// `is_surface` must be up to date on ghosts.
template <int Dim>
void find_interior_by_marks(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double spacing,
                            std::span<const std::uint8_t> is_surface, std::span<double> interior);

}  // namespace tailwater
