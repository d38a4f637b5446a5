#include "base/for_each.h"
#include "closures/smagorinsky.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {

template <int Dim>
void remember(Flow<Dim>& flow) {
  flow.neighbourhood.wrap(flow.particles);
  const auto owned = static_cast<std::ptrdiff_t>(flow.particles.owned);
  flow.position_old.assign(flow.particles.position.begin(), flow.particles.position.begin() + owned);
  flow.velocity_old.assign(flow.particles.velocity.begin(), flow.particles.velocity.begin() + owned);
}

template <int Dim>
void predict(Flow<Dim>& flow, double dt) {
  Particles<Dim>& particles = flow.particles;
  const Pairs<Dim>& pairs = flow.pairs();
  update_wall_velocity(flow, particles.velocity);

  flow.viscosity.resize(particles.size());
  flow.acceleration.assign(particles.owned, Vec<Dim>::Zero());
  effective_viscosity<Dim>(flow.viscosity_law, particles.velocity, flow.viscosity);
  if (flow.scheme.laplacian == LaplacianKind::consistent) {
    add_consistent_viscosity<Dim>(pairs, particles, flow.tensors, flow.takes_part, flow.spacing, flow.viscosity,
                                  particles.velocity, flow.acceleration);
  } else {
    add_morris_viscosity<Dim>(pairs, particles, flow.spacing, flow.viscosity, particles.velocity, flow.acceleration);
  }
  // The consistent Laplacian takes the velocity of particles that stand on the wall, and with it their friction.
  if (flow.scheme.laplacian == LaplacianKind::morris || flow.walls.treatment == WallTreatment::dummies) {
    add_wall_friction<Dim>(pairs, particles, flow.walls, flow.viscosity_law, flow.spacing, particles.velocity,
                           flow.wall_mean, flow.acceleration);
  }
  if (flow.scheme.smagorinsky > 0.0) {
    flow.stress.resize(particles.size());
    sub_particle_stress<Dim>(pairs, particles, flow.scheme.smagorinsky, flow.spacing, particles.velocity, flow.stress);
    flow.neighbourhood.halo().exchange(flow.stress);
    add_stress_divergence<Dim>(pairs, particles, flow.stress, flow.acceleration);
  }
  for_each(particles.owned, [&](std::size_t i) {
    if (particles.is_fluid(i)) flow.u_star[i] = flow.velocity_old[i] + dt * flow.acceleration[i];
  });
  update_wall_velocity(flow, flow.u_star);
}

template void remember<2>(Flow<2>&);
template void remember<3>(Flow<3>&);
template void predict<2>(Flow<2>&, double);
template void predict<3>(Flow<3>&, double);

}  // namespace tailwater
