// Steps of the sampling of walls: body by body, and cell by cell.
#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "sampling/lattice_axis.h"
#include "sampling/wall_layers.h"
#include "sampling/wall_table.h"

namespace tailwater {

/// dx; search radius for the wall of a wall particle, which is nearer to its wall.
inline constexpr double reach_to_wall = 8.0;

/// The particles of several parts, with numbers one after the other.
template <int Dim>
WallParticles<Dim> joined(std::vector<WallParticles<Dim>> parts);

/// Samples each body as if it were alone, because bodies separate.
template <int Dim>
WallParticles<Dim> sample_bodies(const Boundary<Dim>& boundary, const WallLayers& layers, const Lattice<Dim>& lattice);

/// Appends a part of the particle `row` of `whole`.
template <int Dim>
void append_part(WallParticles<Dim>& parts, const WallParticles<Dim>& whole, std::size_t row, const Vec<Dim>& position,
                 double share, std::int64_t number);

/// Divides the particles of walls whose cells are cut by a plate that ends on the wall. Each part acts on the water of
/// its side. A whole particle would fill too much of the support on one side of the plate's foot and too little on the
/// other, and still water would circulate.
template <int Dim>
void cut_by_plates(const Boundary<Dim>& boundary, double spacing, WallParticles<Dim>& particles);

}  // namespace tailwater
