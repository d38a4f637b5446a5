#include "base/for_each.h"
#include "closures/smagorinsky.h"
#include "operators/gradient_corrected.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {

template <int Dim>
void remember(Flow<Dim>& flow) {
  flow.neighbourhood.wrap(flow.particles);
  const auto owned = static_cast<std::ptrdiff_t>(flow.particles.owned);
  flow.position_old.assign(flow.particles.position.begin(), flow.particles.position.begin() + owned);
  flow.velocity_old.assign(flow.particles.velocity.begin(), flow.particles.velocity.begin() + owned);
  flow.wall_velocity_old = flow.walls.velocity;
  flow.energy_old = fluid_sums_of_rank(flow).energy;
}

template <int Dim>
void predict(Flow<Dim>& flow, double dt) {
  Particles<Dim>& particles = flow.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  update_wall_velocity(flow, flow.walls.velocity, particles.velocity);

  flow.viscosity.resize(particles.size());
  flow.acceleration.assign(particles.owned, Vec<Dim>::Zero());
  effective_viscosity<Dim>(flow.viscosity_law, particles.velocity, flow.viscosity);
  if (flow.scheme.laplacian == LaplacianKind::consistent) {
    add_consistent_viscosity<Dim>(pairs, particles, flow.tensors, flow.takes_part, flow.spacing, flow.viscosity,
                                  particles.velocity, flow.acceleration);
  } else if (flow.scheme.laplacian == LaplacianKind::shao_lo) {
    add_shao_lo_viscosity<Dim>(pairs, particles, flow.eta_squared, flow.concentration, flow.viscosity,
                               particles.velocity, flow.acceleration);
  } else {
    add_morris_viscosity<Dim>(pairs, particles, flow.spacing, flow.viscosity, particles.velocity, flow.acceleration);
  }
  // The consistent Laplacian takes the velocity of particles that stand on the wall, and with it their friction.
  if (flow.scheme.laplacian != LaplacianKind::consistent || flow.walls.treatment == WallTreatment::dummies) {
    add_wall_friction<Dim>(pairs, particles, flow.walls, flow.viscosity_law, flow.spacing, particles.velocity,
                           flow.wall_mean, flow.acceleration);
  }
  add_side_wall_friction<Dim>(particles, flow.viscosity_law, particles.velocity, flow.acceleration);
  if (flow.uses_velocity_gradient()) {
    flow.velocity_gradient.resize(particles.size());
    for_each(particles.owned, [&](std::size_t i) {
      flow.velocity_gradient[i] = particles.is_fluid(i)
                                      ? corrected_gradient<Dim>(pairs, i, particles.volume, flow.takes_part,
                                                                std::span<const Vec<Dim>>(particles.velocity))
                                      : Mat<Dim>(Mat<Dim>::Zero());
    });
    flow.neighbourhood.halo().exchange(flow.velocity_gradient);
  }
  if (flow.scheme.noise_viscosity > 0.0) {
    add_noise_viscosity<Dim>(pairs, particles, flow.spacing, flow.noise_viscosity(largest_speed(flow)),
                             particles.velocity, flow.velocity_gradient, flow.acceleration);
  }
  if (flow.scheme.smagorinsky > 0.0) {
    flow.stress.resize(particles.size());
    sub_particle_stress<Dim>(pairs, particles, flow.scheme.smagorinsky, flow.spacing, particles.velocity, flow.stress);
    flow.neighbourhood.halo().exchange(flow.stress);
    add_stress_divergence<Dim>(pairs, particles, flow.stress, flow.acceleration);
  }
  const Vec<Dim> gravity = flow.predicts_gravity() ? flow.gravity : Vec<Dim>(Vec<Dim>::Zero());
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    if (flow.is_leaving(i)) flow.acceleration[i].setZero();  // nothing but gravity, which the end's pressure holds
    flow.u_star[i] = flow.velocity_old[i] + dt * (flow.acceleration[i] + gravity);
  });
  update_wall_velocity(flow, flow.predicts_gravity() ? flow.wall_velocity_next : flow.wall_velocity_old, flow.u_star);
}

template <int Dim>
void aim(Flow<Dim>& flow, double dt) {
  flow.target_divergence.assign(flow.particles.owned, 0.0);
  if (flow.scheme.divergence_free != DivergenceFree::midway) return;
  for_each(flow.particles.owned, [&](std::size_t i) {
    const Mat<Dim>& gradient = flow.velocity_gradient[i];
    flow.target_divergence[i] = 0.5 * dt * (gradient * gradient).trace();
  });
}

template void aim<2>(Flow<2>&, double);
template void aim<3>(Flow<3>&, double);
template void remember<2>(Flow<2>&);
template void remember<3>(Flow<3>&);
template void predict<2>(Flow<2>&, double);
template void predict<3>(Flow<3>&, double);

}  // namespace tailwater
