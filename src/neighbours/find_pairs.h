// The search for pairs: all particles within the support of each owned one.
#pragma once

#include "neighbours/cell_grid.h"
#include "neighbours/halo.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// Finds pairs.place of all particles at their present positions. `radius` [m] is that of the support.
template <int Dim>
void find_places(const Particles<Dim>& particles, const PeriodicDomain<Dim>& domain, double radius, Pairs<Dim>& pairs);

/// Makes the pairs of all owned particles, whose places are found; ghosts are neighbours only. `grid` has all
/// particles, where they are now, and the kernel's support as its reach. Particles nearer than `min_distance` [m]
/// count as that far apart.
template <int Dim>
void find_pairs(const Kernel<Dim>& kernel, const CellGrid<Dim>& grid, const Particles<Dim>& particles,
                WallRows wall_rows, double min_distance, Pairs<Dim>& pairs);

}  // namespace tailwater
