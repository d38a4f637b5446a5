#include <algorithm>
#include <cstdint>

#include "base/for_each.h"
#include "closures/viscosity.h"
#include "flow/balanced_pressure.h"
#include "flow/measure.h"
#include "motion/wall_motion.h"
#include "neighbours/halo.h"
#include "robust/discretisation.h"

namespace tailwater {
namespace {

/// Density over that of the case of liquids whose noise is damped; 0 of others and of walls.
template <int Dim>
std::vector<float> densities_of_thin_liquids(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const ParticleLiquids& liquids = flow.setup.liquids;
  std::vector<float> density(particles.size(), 0.0F);
  for_each(density.size(), [&](std::size_t i) {
    if (particles.is_fluid(i) && liquids.is_thin[liquids.of(particles.id[i])] != 0) {
      density[i] = flow.surroundings.interfaces.density[i];
    }
  });
  return density;
}

/// Factor of the noise viscosity of each particle: 0 with the hull of a floating body and no other wall in its support,
/// otherwise 1. The turn of the water around the edges of a hull is not smooth on the scale of the particles; damped as
/// noise, it would damp the body. Water between a hull and another wall is disordered, and keeps the damping. Empty
/// without bodies.
template <int Dim>
std::vector<float> noise_factors_beside_hulls(const Flow<Dim>& flow) {
  std::vector<std::uint8_t> is_hull(flow.walls.boundary.walls.size(), 0);
  for (const auto& moving : flow.setup.wall_motion->moving()) is_hull[moving.wall] = moving.body >= 0 ? 1 : 0;
  if (std::ranges::find(is_hull, 1) == is_hull.end()) return {};
  const Particles<Dim>& particles = flow.state.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  std::vector<float> factor(particles.size(), 1.0F);
  for_each(particles.owned, [&](std::size_t i) {
    bool is_beside_hull = false;
    bool is_beside_other = false;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = static_cast<std::size_t>(pairs.j[k]);
      if (particles.is_fluid(j)) continue;
      const bool is_of_hull = is_hull[flow.walls.particles.wall[particles.wall_row[j]]] != 0;
      (is_of_hull ? is_beside_hull : is_beside_other) = true;
    }
    if (is_beside_hull && !is_beside_other) factor[i] = 0.0F;
  });
  flow.halo().exchange(factor);
  return factor;
}

/// Noise viscosity, and the factor of each particle; no factors stand for 1.
struct NoiseDamping {
  double viscosity = 0.0;  ///< m^2/s
  std::vector<float> factor = {};
};

/// The noise in a border of a zone comes from supports that vary, not from errors in proportion to p - q. There the
/// noise viscosity is that of the whole pressure.
template <int Dim>
NoiseDamping damping_of_noise(const Flow<Dim>& flow) {
  if (flow.setup.formulation.noise_viscosity == 0.0) return {};
  const double speed = largest_speed(flow);
  NoiseDamping damping{noise_viscosity(flow, speed), noise_factors_beside_hulls(flow)};
  const double in_borders = largest_noise_viscosity(flow, speed);
  if (flow.surroundings.support_terms.is_empty() || in_borders == damping.viscosity) return damping;
  const auto outside = static_cast<float>(damping.viscosity / in_borders);
  damping.viscosity = in_borders;
  damping.factor.resize(flow.state.particles.size(), 1.0F);
  for_each(flow.state.particles.owned, [&](std::size_t i) {
    if (!flow.surroundings.support_terms.is_near_border(i)) damping.factor[i] *= outside;
  });
  flow.halo().exchange(damping.factor);
  return damping;
}

}  // namespace

template <int Dim>
void RobustDiscretisation<Dim>::add_viscous_force(const Flow<Dim>& flow, std::span<const Mat<Dim>> velocity_gradient,
                                                  std::vector<Vec<Dim>>& acceleration) const {
  const Setup<Dim>& setup = flow.setup;
  const Particles<Dim>& particles = flow.state.particles;
  std::vector<double> viscosity(particles.size(), 0.0);
  const NoiseDamping noise = damping_of_noise(flow);
  std::vector<float> density;  // of particles, if there are several liquids
  if (setup.has_implicit_viscosity) {
    if (noise.viscosity == 0.0 || std::ranges::count(setup.liquids.is_thin, 1) == 0) return;
    density = densities_of_thin_liquids(flow);
  } else {
    effective_viscosity<Dim>(setup.liquid.viscosity, particles.velocity, viscosity);
  }
  for (const auto& part : flow.parts) part->add_viscosity(flow, viscosity);
  add_newtonian_viscosity<Dim>(flow.pairs(), particles, setup.scale.spacing, flow.surroundings.pair_vectors, viscosity,
                               noise.viscosity, particles.velocity, velocity_gradient, acceleration, density,
                               noise.factor);
}

#define TAILWATER_INSTANTIATE(Dim)                                                                        \
  template void RobustDiscretisation<Dim>::add_viscous_force(const Flow<Dim>&, std::span<const Mat<Dim>>, \
                                                             std::vector<Vec<Dim>>&) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
