// A picture of a case at its start, for errors that only a person can see.
#pragma once

#include <span>
#include <string>

#include "case/spec.h"
#include "geometry/boundary.h"
#include "sampling/fluid_particles.h"
#include "sampling/wall_particles.h"

namespace tailwater {

/// An SVG document: walls with the particles behind them, the fluid, zones, porous layers, mooring lines and probes
/// with their names, axes in metres, title, spacing and counts. In 3D it is the projection on x and z. Above 40 000
/// fluid (or wall) particles it shows the outlines of the blocks (or the wall alone) instead, and above 20 000 faces no
/// faces. `ducts` are those of the case (find_ducts). `bad_places` are circled.
template <int Dim>
std::string preview_svg(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid,
                        const WallParticles<Dim>& walls, std::span<const Duct<Dim>> ducts,
                        std::span<const Vec<Dim>> bad_places = {});

}  // namespace tailwater
