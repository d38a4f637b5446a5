// The water that stands in the ducts outside of inlets and outlets at the start.
#pragma once

#include <vector>

#include "geometry/boundary.h"
#include "sampling/fluid_particles.h"

namespace tailwater {

template <int Dim>
struct WaterParticle {
  Vec<Dim> position;
  Vec<Dim> velocity;
  double volume;  ///< m^Dim
  int block;      ///< index into CaseSpec::fluid
};

/// Continues the water in front of each mouth along its normal: copies of the particles within a spacing [m] of the
/// mouth, a spacing apart, to the end of the duct. A duct without water at its mouth is dry. Collective; all particles
/// on every rank.
template <int Dim>
std::vector<WaterParticle<Dim>> water_in_ducts(const std::vector<Duct<Dim>>& ducts, double spacing,
                                               const FluidParticles<Dim>& fluid);

/// Appends to the fluid, which was made with as many `others` more that follow it, this rank's part of more water.
template <int Dim>
void append_water(const std::vector<WaterParticle<Dim>>& water, std::int64_t others, FluidParticles<Dim>& fluid);

}  // namespace tailwater
