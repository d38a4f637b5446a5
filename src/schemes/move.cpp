#include "base/for_each.h"
#include "closures/wall_contact.h"
#include "schemes/verbs.h"

namespace tailwater {

template <int Dim>
void drift(Flow<Dim>& flow, double dt) {
  for_each(flow.particles.owned, [&](std::size_t i) {
    if (flow.particles.is_fluid(i)) flow.particles.position[i] = flow.position_old[i] + dt * flow.u_star[i];
  });
  place_walls(flow, flow.time + dt);
}

template <int Dim>
void move(Flow<Dim>& flow, double dt, Interventions& interventions) {
  Particles<Dim>& particles = flow.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) return;
    const Vec<Dim> velocity = flow.scheme.displacement == Displacement::mean_velocity
                                  ? Vec<Dim>(0.5 * (flow.velocity_old[i] + particles.velocity[i]))
                                  : particles.velocity[i];
    particles.position[i] = flow.position_old[i] + dt * velocity;
  });
  place_walls(flow, flow.time + dt);
  interventions.put_back += keep_off_walls<Dim>(flow.pairs(), flow.boundary, flow.spacing, ways_of_walls(flow, dt),
                                                flow.position_old, particles, particles.velocity);
}

template void drift<2>(Flow<2>&, double);
template void drift<3>(Flow<3>&, double);
template void move<2>(Flow<2>&, double, Interventions&);
template void move<3>(Flow<3>&, double, Interventions&);

}  // namespace tailwater
