// Velocity of the particles that stand for walls.
//
//   mean_w = sum_f W u_f / sum_f W                       (Shepard mean of the fluid in reach)
//   dummies:        u_w = V + (I - 2 M) (mean - V)            the mirror image: normal part reversed, tangential kept
//   pressure rows:  u_w = V + (1 - lambda) (I - M) (mean - V) the particle is on the wall: nothing goes through it
//
// V is the wall's own velocity, M is the projector on the directions the wall blocks, lambda the wall's friction. A
// wall particle with no fluid in reach is dry and at rest. Mirror images after Adami, Hu & Adams (2012), free slip for
// any friction: the divergence is that of water that glides past a boundary layer thinner than dx; friction is a stress
// (viscosity.h). With the image of no slip the divergence along the wall is that of water that turns back in it.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/sampling.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// The walls as a step needs them: what each wall particle is, by its row in the table.
template <int Dim>
struct WallModel {
  WallParticles<Dim> particles;
  std::vector<double> friction;    ///< lambda of each wall particle's wall
  std::vector<Vec<Dim>> velocity;  ///< m/s; V of each wall particle
  WallTreatment treatment = WallTreatment::dummies;
};

/// Fills `fluid_weight` [1/m^Dim] (sum of W over fluid neighbours; 0 for fluid particles) and `is_wet` for walls.
template <int Dim>
void find_wet_walls(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double W_0,
                    std::span<double> fluid_weight, std::span<std::uint8_t> is_wet);

/// Sets the wall entries of `velocity`, and of `mean` to the Shepard mean it came from. Fluid entries stay. `V` has one
/// entry per row of the table of wall particles: their velocity, or 0 for a field that is a change of velocity.
template <int Dim>
void set_wall_velocity(const Pairs<Dim>& pairs, const Particles<Dim>& particles, const WallModel<Dim>& walls,
                       std::span<const double> fluid_weight, std::span<const std::uint8_t> is_wet,
                       std::span<const Vec<Dim>> V, std::span<Vec<Dim>> mean, std::span<Vec<Dim>> velocity);

}  // namespace tailwater
