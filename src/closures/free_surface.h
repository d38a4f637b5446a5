// How near the free surface is, where no particle has to be recognised as surface (docs/theory/closures.md).
#pragma once

#include <cstdint>
#include <span>

#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// Marks owned fluid particles with C/C_0 < 0.85, for the field files only: nothing in the scheme needs it.
template <int Dim>
void mark_thin_water(const Particles<Dim>& particles, std::span<const double> concentration,
                     std::span<std::uint8_t> is_surface);

/// The `interior` of each owned fluid particle: 0 in the two outermost rows, 1 from the third row on; 0 for
/// walls. It is a smooth step, from 0.94 to 0.98, of the mean concentration Cm_i = sum W C_j/C_0 / sum W over the fluid
/// including the particle itself. At a flat surface Cm = 0.83, 0.93, 0.99, 1.00 row by row (2D). Continuous in the
/// positions. `concentration` must be up to date on ghosts.
template <int Dim>
void find_interior(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::span<const double> concentration,
                   double W_0, std::span<double> interior);

}  // namespace tailwater
